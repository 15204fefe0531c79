/// \file
/// Everything that Cagewright offers. Each header can also be included alone.
#pragma once

#include <cagewright/cage/density.h>
#include <cagewright/cage/generate.h>
#include <cagewright/cage/option_table.h>
#include <cagewright/coordinates/compact_weights.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/coordinates/mean_value.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/deform/deformer.h>
#include <cagewright/deform/match_pose.h>
#include <cagewright/deform/normals.h>
#include <cagewright/deform/standard_poses.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/point_cache.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/read_vertex_weights.h>
#include <cagewright/io/rewrite_positions.h>
#include <cagewright/io/skinned_cage.h>
#include <cagewright/io/write_animation.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>
#include <cagewright/version.h>
#if CAGEWRIGHT_BUILD_RENDER
#include <cagewright/render/render.h>
#endif
