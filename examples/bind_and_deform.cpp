// Binds a model to a cage, lifts the upper half of the cage by a tenth of its height, and writes
// the model that followed it.
//
//   bind_and_deform MODEL CAGE OUT
#include <cagewright/deform/deformer.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/measures.h>

#include <iostream>

namespace {

int fail(const cagewright::Error& error) {
  std::cerr << error.message << '\n';
  return 2;
}

} // namespace

int main(int argc, char** argv) {
  using namespace cagewright;
  if (argc != 4) {
    std::cerr << "usage: bind_and_deform MODEL CAGE OUT\n";
    return 2;
  }
  Result<PolygonMesh> model = read_mesh(argv[1]);
  if (!model) {
    return fail(model.error());
  }
  const Result<PolygonMesh> cage = read_mesh(argv[2]);
  if (!cage) {
    return fail(cage.error());
  }
  Result<Deformer> deformer = Deformer::bind(*model, *cage);
  if (!deformer) {
    return fail(deformer.error());
  }

  const Box3 box = bounding_box(cage->positions);
  for (Index v = 0; v < cage->positions.size(); ++v) {
    const Vec3& rest = cage->positions[v];
    if (rest.y() > box.center().y()) {
      deformer->move_cage_vertex(v, rest + 0.1 * box.sizes().y() * Vec3::UnitY());
    }
  }
  deformer->update(); // costs what moved, not what stands still

  model->positions.assign(deformer->positions().begin(), deformer->positions().end());
  if (const Status written = write_mesh(*model, argv[3]); !written) {
    return fail(written.error());
  }
  std::cout << model->positions.size() << " vertices followed the cage\n";
  return 0;
}
