// Mean value coordinates of points of your own, for interpolating anything that is known at the
// vertices of a closed mesh: here a temperature at the corners of a tetrahedron.
#include <cagewright/coordinates/mean_value.h>

#include <array>
#include <iostream>

int main() {
  using namespace cagewright;
  TriangleMesh cage;
  cage.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  cage.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const std::array<double, 4> temperature = {0, 10, 20, 30};
  const std::array<Vec3, 2> points = {Vec3(0.25, 0.25, 0.25), Vec3(0.1, 0.2, 0.3)};

  const Result<Weights> weights = mean_value_coordinates(cage, points);
  if (!weights) {
    std::cerr << weights.error().message << '\n';
    return 2;
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    double value = 0;
    for (std::size_t c = 0; c < temperature.size(); ++c) {
      value += weights->at(p, c) * temperature[c];
    }
    std::cout << points[p].transpose() << ": " << value << " degrees\n"; // 15 and 14
  }
  return 0;
}
