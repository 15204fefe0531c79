// Makes a cage for a model.
//
//   make_cage MODEL CAGE.obj

#include "cage/generate.h"
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <iostream>

int main(int argc, char** argv) {
  using namespace cagewright;
  if (argc != 3) {
    std::cerr << "usage: make_cage MODEL CAGE.obj\n";
    return 2;
  }
  const Result<PolygonMesh> mesh = read_mesh(argv[1]);
  if (!mesh) {
    std::cerr << mesh.error().message << '\n';
    return 2;
  }
  GenerateOptions options;
  options.boxes.slicing.depth = 4;
  const Result<GeneratedCage> made = generate_cage(to_triangle_mesh(*mesh), options);
  if (!made) {
    std::cerr << made.error().message << '\n';
    return 1;
  }
  const Status written = write_mesh(PolygonMesh(made->cage), argv[2]);
  if (!written) {
    std::cerr << written.error().message << '\n';
    return 2;
  }
  std::cout << made->leaves.size() << " boxes, " << made->cage.positions.size() << " vertices\n";
  return 0;
}
