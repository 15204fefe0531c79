/// \file
/// All of a document that undo brings back.
#pragma once

#include "app/document/coordinate_choice.h"
#include "app/edit/selection.h"
#include "cage/decompose.h"
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <QString>

#include <memory>
#include <vector>

namespace cagewright::app {

class Binding;
struct Region;

enum class Mode {
  refine, ///< the cage is edited: its rest is what moves
  deform, ///< the model is bound: the cage's pose moves, and the model with it
};

/// Positions that are shared, because states are copied for every step of undo.
using SharedPositions = std::shared_ptr<const std::vector<Vec3>>;

/// A state of the cage with a name.
struct Pose {
  QString name;
  SharedPositions positions; ///< C
  /// How much of it, as what it moves from the rest, is in the cage as it is edited; what the mixer
  /// shows. The cage may have been moved besides.
  double share = 0;
};

/// A state of the cage at a time.
struct Keyframe {
  int frame = 0;
  SharedPositions positions;       ///< C
  std::vector<double> shares = {}; ///< of the poses; those that came later have none
};

/// A point of the model by which it is dragged, or held.
struct Pin {
  Index triangle = 0;                                 ///< of Model::triangles
  Vec3 shares = Vec3::Zero();                         ///< barycentric: of its corners
  std::shared_ptr<const std::vector<double>> weights; ///< C
};

/// One number for each vertex of the model: where the cage is to be finer (to 1) or coarser
/// (to -1).
using SharedDensity = std::shared_ptr<const std::vector<float>>;

struct TimeLine {
  static constexpr int least_frame = -9999;
  static constexpr int most_frame = 99999;

  std::vector<Keyframe> keys; ///< by frame, each frame once
  int first = 1;
  int last = 100;
  double frames_per_second = 24;
};

/// Cheap to copy: everything large is shared and never changed.
struct State {
  std::shared_ptr<const Region> region;    ///< what of the model the cage is for; null: all of it
  std::shared_ptr<const PolygonMesh> rest; ///< the cage at rest; null: there is none
  /// The cage as it is edited, C positions: in refine mode those of `rest` in effect, with drags
  /// that moved them.
  SharedPositions cage;
  std::shared_ptr<const Binding> binding; ///< null in refine mode
  Selection selection;
  std::vector<Index> hidden_faces; ///< of the cage, ascending: see app/edit/hidden.h
  std::vector<Pose> poses;
  TimeLine time_line;
  std::vector<Pin> pins;                          ///< in deform mode
  SharedDensity density;                          ///< null: none was painted
  SharedShares mix;                               ///< painted for another kind; null: nothing is
  std::shared_ptr<const BoxDecomposition> stages; ///< null: none were made
};

} // namespace cagewright::app
