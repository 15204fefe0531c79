// Makes a cage of at most 60 vertices round a model, of quads where they can be.
//
//   make_cage MODEL CAGE.obj
#include <cagewright/cagewright.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: make_cage MODEL CAGE.obj\n";
    return 2;
  }
  const auto model = cagewright::read_mesh(argv[1]);
  if (!model) {
    std::cerr << model.error().message << '\n';
    return 2;
  }
  const auto made = cagewright::generate_for_polygons(*model, {.vertices = 60, .quads = true});
  if (!made) {
    std::cerr << argv[1] << ": " << made.error().message << '\n';
    return 3;
  }
  for (const cagewright::Remark& remark : made->remarks) {
    std::cerr << remark.message << '\n';
  }
  const auto written = cagewright::write_mesh(made->faces, argv[2]);
  if (!written) {
    std::cerr << written.error().message << '\n';
    return 2;
  }
  std::cout << made->faces.positions.size() << " vertices, " << made->faces.face_count()
            << " faces, a valid cage\n";
  return 0;
}
