// From a model in a file to the posed model in a file: makes a cage of at most so many vertices,
// writes it, and moves the model as a posed copy of that cage says. All else that the model's file
// holds is kept.
//
//   from_file_to_pose MODEL VERTICES CAGE.obj POSED_CAGE OUT
#include <cagewright/cagewright.h>

#include <cstdlib>
#include <iostream>
#include <vector>

namespace {

using namespace cagewright;

int fail(const Error& error) {
  std::cerr << error.message << '\n';
  return 2;
}

/// The normals that the file stores, turned as the surface turns; none where it stores none.
Result<std::vector<Vec3>> turned_normals(const ModelFile& model, std::span<const Vec3> positions) {
  const Result<FileNormals> stored = model.normals();
  if (!stored || stored->normals.empty()) {
    return stored ? Result<std::vector<Vec3>>(std::vector<Vec3>()) : stored.error();
  }
  NormalField field(model.mesh(), {stored->of_corner, stored->normals.size(), stored->normals});
  field.update(positions);
  return std::vector<Vec3>(field.normals().begin(), field.normals().end());
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::cerr << "usage: from_file_to_pose MODEL VERTICES CAGE.obj POSED_CAGE OUT\n";
    return 2;
  }
  const Result<ModelFile> model = ModelFile::open(argv[1]);
  if (!model) {
    return fail(model.error());
  }
  const Result<GeneratedCage> cage =
      generate_for_polygons(model->mesh(), {.vertices = std::atoi(argv[2])});
  if (!cage) {
    return fail(cage.error());
  }
  if (const Status written = write_mesh(cage->faces, argv[3]); !written) {
    return fail(written.error());
  }
  const Result<PolygonMesh> posed = read_mesh(argv[4]);
  if (!posed) {
    return fail(posed.error());
  }
  const Result<MatchedPose> pose = match_pose(cage->faces, *posed, argv[4]);
  if (!pose) {
    return fail(pose.error());
  }
  const auto coordinates = prepare_coordinates(cage->faces, CoordinateSettings());
  if (!coordinates) {
    return fail(coordinates.error());
  }
  const std::vector<std::vector<Vec3>> poses = {pose->positions};
  const Result<StreamedPoses> moved =
      deform_streaming(**coordinates, poses, model->mesh().positions);
  if (!moved) {
    return fail(moved.error());
  }
  const Result<std::vector<Vec3>> normals = turned_normals(*model, moved->positions.front());
  if (!normals) {
    return fail(normals.error());
  }
  const auto notes = model->write_moved(moved->positions.front(), *normals, argv[5]);
  return notes ? 0 : fail(notes.error());
}
