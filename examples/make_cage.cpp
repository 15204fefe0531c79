// Makes a cage for a model.
//
//   make_cage MODEL CAGE.obj

#include <cagewright/cage/generate.h>
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
  const Result<GeneratedCage> made = generate(to_triangle_mesh(*mesh), {.vertices = 60});
  if (!made) {
    std::cerr << made.error().message << '\n';
    return 1;
  }
  for (const Remark& remark : made->remarks) {
    std::cout << remark.message << '\n';
  }
  const Status written = write_mesh(made->faces, argv[2]);
  if (!written) {
    std::cerr << written.error().message << '\n';
    return 2;
  }
  std::cout << made->figures.vertices << " vertices, " << made->figures.volume_ratio
            << " times the model's volume\n";
  return 0;
}
