#include <cagewright/render/render.h>

#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace cagewright {
namespace {

constexpr int size = 240;

RenderOptions small() {
  return {.width = size, .height = size, .view = {0, 0}, .samples = 2};
}

PolygonMesh scaled(const TriangleMesh& mesh, double factor, const Vec3& offset = Vec3::Zero()) {
  PolygonMesh result(mesh);
  for (Vec3& p : result.positions) {
    p = factor * p + offset;
  }
  return result;
}

int difference(const Pixel& a, const Pixel& b) {
  int most = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
  }
  return most;
}

/// Share of pixels that differ visibly.
double share_different(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    count += difference(a.pixels[i], b.pixels[i]) > 12 ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}

bool is_warm(const Pixel& p) {
  return p[0] > p[2] + 10;
}
bool is_blue(const Pixel& p) {
  return p[2] > p[0] + 40;
}

class Rendering : public testing::Test {
protected:
  static void SetUpTestSuite() {
    Result<Renderer> created = Renderer::create();
    ASSERT_TRUE(created) << created.error().message;
    renderer.emplace(std::move(*created));
  }
  static void TearDownTestSuite() { renderer.reset(); }

  static Image draw(const Scene& scene, const RenderOptions& options = small()) {
    Result<Image> image = renderer->render(scene, options);
    EXPECT_TRUE(image) << image.error().message;
    return image ? *image : Image{size, size, std::vector<Pixel>(size * size)};
  }

  static Error refusal(const Scene& scene, const RenderOptions& options = small()) {
    const Result<Image> image = renderer->render(scene, options);
    EXPECT_FALSE(image);
    return image ? Error{ErrorCode::malformed, "none"} : image.error();
  }

  static std::optional<Renderer> renderer; // one context for all tests
  const PolygonMesh sphere{make_icosphere(3)};
  const PolygonMesh cube = scaled(make_cube(), 1.1);
};

std::optional<Renderer> Rendering::renderer;

TEST_F(Rendering, ShowsTheModelInTheMiddleAndTheBackgroundAround) {
  RenderOptions options = small();
  options.background = Background::white;
  options.shadows = false;
  const Image image = draw({{Layer::model(sphere)}}, options);
  EXPECT_TRUE(is_warm(image.at(size / 2, size / 2)));
  for (const int x : {0, size - 1}) {
    for (const int y : {0, size - 1}) {
      EXPECT_EQ(image.at(x, y), (Pixel{255, 255, 255, 255}));
    }
  }
}

TEST_F(Rendering, FillsTheFrame) {
  RenderOptions options = small();
  options.background = Background::transparent;
  options.margin = 0.1;
  const Image image = draw({{Layer::model(sphere)}}, options);
  int first = size;
  int last = 0;
  for (int x = 0; x < size; ++x) {
    if (image.at(x, size / 2)[3] > 128) {
      first = std::min(first, x);
      last = std::max(last, x);
    }
  }
  EXPECT_NEAR(first, 0.1 * size, 2);
  EXPECT_NEAR(last, 0.9 * size, 2);
}

TEST_F(Rendering, LightsFromAbove) {
  const Image image = draw({{Layer::model(sphere)}});
  EXPECT_GT(image.at(size / 2, size / 5)[1], image.at(size / 2, 4 * size / 5)[1] + 30);
}

TEST_F(Rendering, CastsShadows) {
  // A small ball between the light and a large one, drawn from the front.
  PolygonMesh balls(joined(make_icosphere(3), make_icosphere(3)));
  const std::size_t half = balls.positions.size() / 2;
  for (std::size_t v = 0; v < half; ++v) {
    balls.positions[v] = 0.3 * balls.positions[v] + Vec3(-0.8, 1.2, 1.0);
  }
  RenderOptions options = small();
  options.background = Background::transparent;
  const Image shaded = draw({{Layer::model(balls)}}, options);
  options.shadows = false;
  const Image bare = draw({{Layer::model(balls)}}, options);
  int darker = 0;
  int on_the_ground = 0;
  for (std::size_t i = 0; i < bare.pixels.size(); ++i) {
    darker += bare.pixels[i][3] == 255 && shaded.pixels[i][0] + 20 < bare.pixels[i][0] ? 1 : 0;
    on_the_ground += bare.pixels[i][3] == 0 && shaded.pixels[i][3] > 20 ? 1 : 0;
  }
  EXPECT_GT(darker, 50);
  EXPECT_GT(on_the_ground, 50);
}

TEST_F(Rendering, DrawsTheCagesEdgesWhereTheyProject) {
  // The front face of the cube nearly fills the frame; its left edge is the silhouette.
  RenderOptions options = small();
  options.vertex_radius = 0;
  options.margin = 0.1;
  const Image image = draw({{Layer::model(sphere), Layer::cage(cube)}}, options);
  int bluest = 0;
  for (int x = 0; x < size / 2; ++x) {
    const Pixel& p = image.at(x, size / 3);
    const Pixel& best = image.at(bluest, size / 3);
    bluest = p[2] - p[0] > best[2] - best[0] ? x : bluest;
  }
  EXPECT_NEAR(bluest, 0.1 * size, 1.5);
  EXPECT_TRUE(is_blue(image.at(bluest, size / 3)));
}

TEST_F(Rendering, DrawsNoDiagonalsOfPolygons) {
  PolygonMesh quad;
  quad.positions = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  quad.add_face({0, 1, 2, 3});
  PolygonMesh triangles;
  triangles.positions = quad.positions;
  triangles.add_face({0, 1, 2});
  triangles.add_face({0, 2, 3});
  EXPECT_FALSE(is_blue(draw({{Layer::cage(quad)}}).at(size / 2, size / 2)));
  EXPECT_TRUE(is_blue(draw({{Layer::cage(triangles)}}).at(size / 2, size / 2)));
}

TEST_F(Rendering, ShowsTheModelThroughTheCage) {
  const Image bare = draw({{Layer::model(sphere)}});
  RenderOptions options = small();
  options.cage_opacity = 1;
  const Image tinted = draw({{Layer::model(sphere), Layer::cage(cube)}});
  const Image covered = draw({{Layer::model(sphere), Layer::cage(cube)}}, options);
  // Off the diagonals of the cube's triangles.
  const Pixel& seen = tinted.at(size / 2, size / 3);
  EXPECT_FALSE(is_blue(bare.at(size / 2, size / 3)));
  EXPECT_TRUE(is_blue(covered.at(size / 2, size / 3)));
  EXPECT_GT(seen[0], covered.at(size / 2, size / 3)[0] + 30);
  EXPECT_GT(difference(seen, bare.at(size / 2, size / 3)), 8);
}

TEST_F(Rendering, DrawsHiddenEdgesFainter) {
  // One edge passes before the sphere, the other behind it, at the same place of the picture.
  PolygonMesh before;
  before.positions = {Vec3(-2, 0, 1.2), Vec3(2, 0, 1.2), Vec3(2, 0, 1.2)};
  before.add_face({0, 1, 2});
  PolygonMesh behind = before;
  for (Vec3& p : behind.positions) {
    p.z() = -1.2;
  }
  RenderOptions options = small();
  options.vertex_radius = 0;
  const Pixel bare = draw({{Layer::model(sphere)}}, options).at(size / 2, size / 2);
  const auto darkest_of_middle = [&](const PolygonMesh& line) {
    const Image image = draw({{Layer::model(sphere), Layer::cage(line)}}, options);
    int least = 255;
    for (int x = size / 2 - 20; x < size / 2 + 20; ++x) {
      for (int y = size / 2 - 3; y <= size / 2 + 3; ++y) {
        least = std::min<int>(least, image.at(x, y)[0]);
      }
    }
    return least;
  };
  EXPECT_LT(darkest_of_middle(before), bare[0] / 2);
  EXPECT_GT(darkest_of_middle(behind), bare[0] / 2);
  EXPECT_LT(darkest_of_middle(behind), bare[0] - 8);
}

TEST_F(Rendering, IsTheSameEveryTime) {
  const Scene scene{{Layer::model(sphere), Layer::cage(cube)}};
  const Image once = draw(scene);
  EXPECT_EQ(once.pixels, draw(scene).pixels);
  const Result<Image> elsewhere = render(scene, small());
  ASSERT_TRUE(elsewhere) << elsewhere.error().message;
  EXPECT_EQ(once.pixels, elsewhere->pixels);
}

TEST_F(Rendering, DoesNotDependOnSizeOrPlace) {
  const Image normal = draw({{Layer::model(sphere), Layer::cage(cube)}});
  for (const double factor : {1e-6, 1e6, 1e200}) {
    const Vec3 offset = factor * Vec3(1000, -2000, 500);
    const PolygonMesh moved_sphere = scaled(make_icosphere(3), factor, offset);
    const PolygonMesh moved_cube = scaled(make_cube(), 1.1 * factor, offset);
    const Image moved = draw({{Layer::model(moved_sphere), Layer::cage(moved_cube)}});
    EXPECT_LT(share_different(normal, moved), 0.002) << factor;
  }
}

TEST_F(Rendering, ColorsGroups) {
  PolygonMesh two(joined(make_cube(), make_cube()));
  for (std::size_t v = 8; v < 16; ++v) {
    two.positions[v].x() += 3;
  }
  two.group_names = {"left", "right"};
  two.face_groups.assign(12, 0);
  two.face_groups.resize(24, 1);
  Layer layer = Layer::model(two);
  layer.color_by_group = true;
  const Image image = draw({{layer}});
  EXPECT_GT(difference(image.at(size / 4, size / 2), image.at(3 * size / 4, size / 2)), 40);
  const Image plain = draw({{Layer::model(two)}});
  EXPECT_LT(difference(plain.at(size / 4, size / 2), plain.at(3 * size / 4, size / 2)), 25);
}

TEST_F(Rendering, ColorsVertices) {
  std::vector<Rgb> colors;
  for (const Vec3& p : sphere.positions) {
    colors.push_back(p.x() < 0 ? Rgb{1, 0, 0} : Rgb{0, 0, 1});
  }
  Layer layer = Layer::model(sphere);
  layer.vertex_colors = colors;
  const Image image = draw({{layer}});
  EXPECT_GT(image.at(size / 3, size / 2)[0], image.at(size / 3, size / 2)[2] + 50);
  EXPECT_GT(image.at(2 * size / 3, size / 2)[2], image.at(2 * size / 3, size / 2)[0] + 50);

  colors.pop_back();
  layer.vertex_colors = colors;
  EXPECT_EQ(refusal({{layer}}).code, ErrorCode::mismatch);
}

TEST_F(Rendering, PutsViewsSideBySide) {
  const PolygonMesh slab = scaled(make_cube(), 1);
  PolygonMesh thin = slab;
  for (Vec3& p : thin.positions) {
    p.x() *= 0.1;
  }
  const std::vector<View> views = {*view_named("front"), *view_named("side")};
  RenderOptions options = small();
  options.background = Background::transparent;
  const Result<Image> image = renderer->render({{Layer::model(thin)}}, views, options);
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 2 * size);
  ASSERT_EQ(image->height, size);
  const int near_the_rim = size / 5;
  EXPECT_EQ(image->at(near_the_rim, size / 2)[3], 0);          // the slab's narrow side
  EXPECT_EQ(image->at(size + near_the_rim, size / 2)[3], 255); // its broad side
}

TEST_F(Rendering, SurvivesDegenerateMeshes) {
  PolygonMesh point;
  point.positions = {Vec3(5, 5, 5), Vec3(5, 5, 5), Vec3(5, 5, 5)};
  point.add_face({0, 1, 2});
  draw({{Layer::model(point), Layer::cage(point)}});
  PolygonMesh line = point;
  line.positions[1].x() += 1;
  draw({{Layer::model(line), Layer::cage(line)}});
}

TEST_F(Rendering, RefusesWhatCannotBeDrawn) {
  EXPECT_EQ(refusal({}).message, "there is nothing to draw");
  const PolygonMesh nothing;
  EXPECT_EQ(refusal({{Layer::model(nothing)}}).code, ErrorCode::unfit_model);
  PolygonMesh bad = sphere;
  bad.positions[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({{Layer::model(bad)}}).message,
            "vertex 7 has a coordinate that is not a number");
}

TEST_F(Rendering, RefusesOptionsOutOfRange) {
  const Scene scene{{Layer::model(sphere)}};
  const auto code_with = [&](auto change) {
    RenderOptions options = small();
    change(options);
    return refusal(scene, options).code;
  };
  EXPECT_EQ(code_with([](RenderOptions& o) { o.width = 0; }), ErrorCode::invalid_option);
  EXPECT_EQ(code_with([](RenderOptions& o) { o.samples = 5; }), ErrorCode::invalid_option);
  EXPECT_EQ(code_with([](RenderOptions& o) { o.margin = 0.5; }), ErrorCode::invalid_option);
  EXPECT_EQ(code_with([](RenderOptions& o) { o.angle_degrees = 0; }), ErrorCode::invalid_option);
  EXPECT_EQ(code_with([](RenderOptions& o) { o.cage_opacity = std::nan(""); }),
            ErrorCode::invalid_option);
  EXPECT_EQ(code_with([](RenderOptions& o) { o.height = 1 << 30; }), ErrorCode::too_large);
  EXPECT_EQ(code_with([](RenderOptions& o) { o.width = o.height = 20000; }), ErrorCode::too_large);
}

TEST_F(Rendering, DrawsLargePicturesWithFewerSamples) {
  const Scene scene{{Layer::model(sphere)}};
  RenderOptions options = small();
  options.width = 9000; // 18,000 samples across are more than drivers hold
  options.height = 60;
  const Result<Image> image = renderer->render(scene, options);
  ASSERT_TRUE(image.has_value()) << image.error().message;
  EXPECT_EQ(image->width, 9000);
}

} // namespace
} // namespace cagewright
