// Takes a model apart into oriented boxes, prints them, and writes their union as a cage.
//
//   boxes MODEL CAGE.obj
#include <cagewright/cage/generate.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <iostream>

int main(int argc, char** argv) {
  using namespace cagewright;
  if (argc != 3) {
    std::cerr << "usage: boxes MODEL CAGE.obj\n";
    return 2;
  }
  const Result<PolygonMesh> model = read_mesh(argv[1]);
  if (!model) {
    std::cerr << model.error().message << '\n';
    return 2;
  }
  const Result<GeneratedCage> made =
      generate(to_triangle_mesh(*model), {.method = Method::boxes, .depth = 4});
  if (!made) { // not_available where the library was built without the union of boxes
    std::cerr << name_of(made.error().code) << ": " << made.error().message << '\n';
    return 3;
  }
  for (const CageBox& box : made->boxes) {
    std::cout << "center " << box.center.transpose() << ", edges " << 2 * box.half.transpose()
              << '\n';
  }
  if (const Status written = write_mesh(made->faces, argv[2]); !written) {
    std::cerr << written.error().message << '\n';
    return 2;
  }
  return 0;
}
