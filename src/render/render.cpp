#include <cagewright/render/render.h>

#include "render/edges.h"
#include "render/gl.h"
#include "render/shaders.h"
#include "render/smooth_normals.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

namespace cagewright {
namespace {

using Vec3f = Eigen::Vector3f;
using Color = std::array<std::uint8_t, 4>; // sRGB and opacity

constexpr float nothing_there = 1e9F; // as a distance from the eye
constexpr int shadow_size = 2048;     // pixels across the scene, as the light sees it

/// Rows: the main light's right and up, and the direction towards it, in view space. It stands
/// above the photographer's left shoulder, from whichever side the picture is taken.
Mat3 light_axes() {
  Mat3 axes;
  axes.row(2) = Vec3(-0.50, 0.80, 0.62).normalized();
  axes.row(0) = Vec3::UnitY().cross(Vec3(axes.row(2))).normalized();
  axes.row(1) = Vec3(axes.row(2)).cross(Vec3(axes.row(0)));
  return axes;
}

struct SolidVertex {
  Vec3f position;
  Vec3f normal;
  Color color;
};
struct FaceVertex {
  Vec3f position;
  Color color;
};
struct LineInstance {
  Vec3f begin;
  Vec3f end;
  Color color;
};
struct DotInstance {
  Vec3f position;
  Color color;
};

/// The scene in units of its radius, about its middle, as the graphics card wants it.
struct Shapes {
  std::vector<Vec3> points; ///< all that must be seen
  std::vector<SolidVertex> solids;
  std::vector<FaceVertex> faces;
  std::vector<LineInstance> fine_lines; ///< of solids
  std::vector<LineInstance> lines;      ///< of cages
  std::vector<DotInstance> dots;
  double ground = 0; ///< height at which the solids stand
};

Color to_color(const Rgb& rgb, double opacity = 1) {
  const auto byte = [](double c) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
  };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2]), byte(opacity)};
}

Rgb darker(const Rgb& rgb, float factor) {
  return {rgb[0] * factor, rgb[1] * factor, rgb[2] * factor};
}

// ---------------------------------------------------------------- from meshes to shapes

/// Brings the scene to the size where floats are precise.
struct Normalization {
  Vec3 center = Vec3::Zero();
  double scale = 1; ///< one over the radius

  // Each term is scaled by itself: the difference of two huge coordinates may not be finite.
  Vec3 operator()(const Vec3& p) const { return p * scale - center * scale; }
};

Result<Normalization> normalization_of(const Scene& scene) {
  Box3 box;
  for (const Layer& layer : scene.layers) {
    for (const Index v : layer.mesh->corners()) {
      const Vec3& p = layer.mesh->positions[v];
      if (!p.allFinite()) {
        return Error{ErrorCode::unfit_model,
                     "vertex " + std::to_string(v) + " has a coordinate that is not a number"};
      }
      box.extend(p);
    }
  }
  if (box.isEmpty()) {
    return Error{ErrorCode::unfit_model, "there is nothing to draw"};
  }
  Normalization normalization;
  normalization.center = box.min() / 2 + box.max() / 2;
  const double radius = (box.max() / 2 - box.min() / 2).stableNorm();
  normalization.scale = radius > 0 && std::isfinite(1 / radius) ? 1 / radius : 1;
  return normalization;
}

/// The colour of each face of a layer.
class FaceColors {
public:
  explicit FaceColors(const Layer& layer) : layer_(layer) {}
  [[nodiscard]] Rgb operator()(std::size_t face) const {
    const std::vector<Index>& groups = layer_.mesh->face_groups;
    return layer_.color_by_group && face < groups.size() ? group_color(groups[face]) : layer_.color;
  }

private:
  const Layer& layer_;
};

void add_solid(const Layer& layer, const TriangleMesh& mesh, const Triangulation& cut,
               const RenderOptions& options, Shapes& shapes) {
  const FaceColors face_color(layer);
  const std::vector<Vec3f> normals = smooth_normals(mesh, options.crease_degrees);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Color flat = to_color(face_color(cut.face_of[t]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = mesh.triangles[t][i];
      const bool own = v < layer.vertex_colors.size();
      shapes.solids.push_back({mesh.positions[v].cast<float>(), normals[3 * t + i],
                               own ? to_color(layer.vertex_colors[v]) : flat});
    }
  }
  if (options.model_edges) {
    const Color color = to_color({0.10F, 0.09F, 0.08F}, 0.35);
    for (const auto& [a, b] : polygon_edges(*layer.mesh)) {
      shapes.fine_lines.push_back(
          {mesh.positions[a].cast<float>(), mesh.positions[b].cast<float>(), color});
    }
  }
}

/// For each vertex, some face that uses it: its colour is the vertex's.
std::vector<std::size_t> faces_of_vertices(const PolygonMesh& mesh) {
  std::vector<std::size_t> face(mesh.positions.size(), 0);
  for (std::size_t f = mesh.face_count(); f-- > 0;) {
    for (const Index v : mesh.face(f)) {
      face[v] = f;
    }
  }
  return face;
}

void add_cage(const Layer& layer, const TriangleMesh& mesh, const Triangulation& cut,
              const RenderOptions& options, Shapes& shapes) {
  const FaceColors face_color(layer);
  if (options.cage_faces) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const Index v : mesh.triangles[t]) {
        shapes.faces.push_back(
            {mesh.positions[v].cast<float>(), to_color(face_color(cut.face_of[t]))});
      }
    }
  }
  const std::vector<std::size_t> face_of = faces_of_vertices(*layer.mesh);
  const auto line_color = [&](Index v) { return to_color(darker(face_color(face_of[v]), 0.62F)); };
  const auto edges = polygon_edges(*layer.mesh, options.least_bend_degrees);
  for (const auto& [a, b] : edges) {
    shapes.lines.push_back(
        {mesh.positions[a].cast<float>(), mesh.positions[b].cast<float>(), line_color(a)});
  }
  for (const Index v : end_points(edges)) {
    shapes.dots.push_back({mesh.positions[v].cast<float>(), line_color(v)});
  }
}

Shapes shapes_of(const Scene& scene, const Normalization& normalized,
                 const RenderOptions& options) {
  Shapes shapes;
  for (const Layer& layer : scene.layers) {
    const Triangulation cut = triangulate(*layer.mesh);
    TriangleMesh mesh{layer.mesh->positions, cut.triangles};
    std::transform(mesh.positions.begin(), mesh.positions.end(), mesh.positions.begin(),
                   normalized);
    for (const Index v : used_points(*layer.mesh)) {
      shapes.points.push_back(mesh.positions[v]);
    }
    if (layer.style == Layer::Style::solid) {
      const Box3 box = bounding_box(mesh);
      shapes.ground =
          std::min(shapes.ground, options.up == UpAxis::y ? box.min().y() : box.min().z());
      add_solid(layer, mesh, cut, options, shapes);
    } else {
      add_cage(layer, mesh, cut, options, shapes);
    }
  }
  return shapes;
}

/// Translucent faces must be drawn from the farthest to the nearest.
std::vector<FaceVertex> sorted_by_depth(const std::vector<FaceVertex>& faces,
                                        const Camera& camera) {
  const Vec3f backward = camera.axes.row(2).transpose().cast<float>();
  std::vector<std::pair<float, std::size_t>> order(faces.size() / 3);
  for (std::size_t t = 0; t < order.size(); ++t) {
    const Vec3f sum = faces[3 * t].position + faces[3 * t + 1].position + faces[3 * t + 2].position;
    order[t] = {backward.dot(sum), t};
  }
  std::sort(order.begin(), order.end());
  std::vector<FaceVertex> sorted;
  sorted.reserve(faces.size());
  for (const auto& [depth, t] : order) {
    sorted.insert(sorted.end(), faces.begin() + static_cast<std::ptrdiff_t>(3 * t),
                  faces.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
  }
  return sorted;
}

// ---------------------------------------------------------------- drawing

/// A program in use; sets its inputs by name.
class Inputs {
public:
  explicit Inputs(const gl::Program& program) : id_(program.id()) { glUseProgram(id_); }

  void set(const char* name, double value) { glUniform1f(at(name), static_cast<float>(value)); }
  void set(const char* name, int value) { glUniform1i(at(name), value); }
  void set(const char* name, double x, double y) {
    glUniform2f(at(name), static_cast<float>(x), static_cast<float>(y));
  }
  void set(const char* name, const Vec3& value) {
    const Vec3f v = value.cast<float>();
    glUniform3fv(at(name), 1, v.data());
  }
  void set(const char* name, const Mat3& value) {
    const Eigen::Matrix3f m = value.cast<float>();
    glUniformMatrix3fv(at(name), 1, GL_FALSE, m.data());
  }
  void set(const char* name, const std::array<std::array<float, 4>, 2>& value) {
    glUniform4fv(at(name), 2, value[0].data());
  }
  void set(const char* name, const gl::Texture& texture) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit_));
    glBindTexture(GL_TEXTURE_2D, texture.id());
    glUniform1i(at(name), unit_++);
  }
  void set(const Camera& camera, double aspect) {
    set("axes", camera.axes);
    set("eye", camera.eye);
    set("slope", camera.tan_half_height * aspect, camera.tan_half_height);
    set("depth_range", camera.nearest, camera.farthest);
  }

private:
  [[nodiscard]] GLint at(const char* name) const { return glGetUniformLocation(id_, name); }
  GLuint id_;
  GLint unit_ = 0;
};

std::array<std::array<float, 4>, 2> background_colors(Background background) {
  const auto opaque = [](const Rgb& srgb) {
    const Rgb c = to_linear(srgb);
    return std::array<float, 4>{c[0], c[1], c[2], 1};
  };
  switch (background) {
  case Background::gradient:
    return {opaque({0.850F, 0.865F, 0.885F}), opaque({0.975F, 0.978F, 0.982F})};
  case Background::white:
    return {opaque({1, 1, 1}), opaque({1, 1, 1})};
  case Background::transparent:
    return {};
  }
  return {};
}

Status check_options(const Scene& scene, std::size_t views, const RenderOptions& options) {
  const auto refuse = [](const std::string& what) {
    return Error{ErrorCode::invalid_option, what};
  };
  if (options.width < 1 || options.height < 1) {
    return refuse("width and height must be at least 1 pixel");
  }
  if (options.samples < 1 || options.samples > 4) {
    return refuse("samples must be from 1 to 4");
  }
  if (!(options.angle_degrees >= 1 && options.angle_degrees <= 120)) {
    return refuse("the angle of view must be from 1 to 120 degrees");
  }
  if (!(options.margin >= 0 && options.margin <= 0.4)) {
    return refuse("the margin must be from 0 to 0.4");
  }
  if (!(options.cage_opacity >= 0 && options.cage_opacity <= 1)) {
    return refuse("the opacity must be from 0 to 1");
  }
  if (!(options.edge_width >= 0 && options.edge_width <= 100 && options.vertex_radius >= 0 &&
        options.vertex_radius <= 100)) {
    return refuse("widths of lines and sizes of dots must be from 0 to 100 pixels");
  }
  if (views == 0) {
    return refuse("there is no view to draw");
  }
  for (const Layer& layer : scene.layers) {
    if (layer.mesh == nullptr) {
      return refuse("a layer has no mesh");
    }
    if (!layer.vertex_colors.empty() &&
        layer.vertex_colors.size() != layer.mesh->positions.size()) {
      return Error{ErrorCode::mismatch,
                   "there are " + std::to_string(layer.vertex_colors.size()) + " colors for " +
                       std::to_string(layer.mesh->positions.size()) + " vertices"};
    }
  }
  return success();
}

/// How many samples a pixel can have, of those asked for.
Result<int> samples_within_memory(const RenderOptions& options) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  // Some 40 bytes a sample: about 4 GB, beyond which drivers fail in ways that cannot be caught.
  constexpr double most_samples = 1e8;
  for (int samples = options.samples; samples > 0; --samples) {
    const double across = static_cast<double>(samples) * options.width;
    const double upward = static_cast<double>(samples) * options.height;
    if (across <= largest && upward <= largest && across * upward <= most_samples) {
      return samples;
    }
  }
  return Error{ErrorCode::too_large, "a picture of " + std::to_string(options.width) + " by " +
                                         std::to_string(options.height) +
                                         " pixels needs too much memory; make it smaller"};
}

} // namespace

struct Renderer::Programs {
  std::unique_ptr<gl::Context> context;
  gl::Program solid, shadow, shade, blur, light, resolve, face, face_distance, line, dot;

  Programs() = default;
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;
  ~Programs() {
    const gl::Context::Use use(*context);
    for (gl::Program* program :
         {&solid, &shadow, &shade, &blur, &light, &resolve, &face, &face_distance, &line, &dot}) {
      *program = gl::Program(); // while the context is current
    }
  }
};

namespace {

/// One picture in the making: the textures that the passes hand to each other.
class Drawing {
public:
  Drawing(const Shapes& shapes, const gl::Elements& solids, const Camera& camera,
          const RenderOptions& options)
      : shapes_(shapes), solids_(solids), camera_(camera), options_(options),
        width_(options.width * options.samples), height_(options.height * options.samples),
        aspect_(static_cast<double>(options.width) / options.height),
        albedo_(gl::make_texture(GL_RGBA8, width_, height_)),
        surface_(gl::make_texture(GL_RGBA16F, width_, height_)),
        distance_(gl::make_texture(GL_R32F, width_, height_)),
        depth_(gl::make_texture(GL_DEPTH_COMPONENT32F, width_, height_)),
        cage_distance_(gl::make_texture(GL_R32F, width_, height_)),
        shadow_map_(gl::make_texture(GL_R32F, shadow_size, shadow_size)),
        shades_(gl::make_texture(GL_RG16F, options.width, options.height)),
        color_(gl::make_texture(GL_RGBA16F, width_, height_)) {}

  void draw_solids(const gl::Program& program) {
    begin({albedo_.id(), surface_.id(), distance_.id()}, depth_.id(), width_, height_);
    constexpr std::array<float, 4> none = {0, 0, 0, 0};
    constexpr std::array<float, 4> far = {nothing_there, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, none.data());
    glClearBufferfv(GL_COLOR, 1, none.data());
    glClearBufferfv(GL_COLOR, 2, far.data());
    glClear(GL_DEPTH_BUFFER_BIT);
    Inputs inputs(program);
    inputs.set(camera_, aspect_);
    with_depth_test([&] { solids_.draw(); });
  }

  /// What stands between the surface and the main light.
  void draw_shadow_map(const gl::Program& program) {
    const gl::Texture depth = gl::make_texture(GL_DEPTH_COMPONENT32F, shadow_size, shadow_size);
    begin({shadow_map_.id()}, depth.id(), shadow_size, shadow_size);
    constexpr std::array<float, 4> far = {-nothing_there, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, far.data());
    glClear(GL_DEPTH_BUFFER_BIT);
    if (options_.shadows) {
      Inputs inputs(program);
      inputs.set("light_axes", Mat3(light_axes() * camera_.axes));
      with_depth_test([&] { solids_.draw(); });
    }
  }

  void find_shades(const gl::Program& shade, const gl::Program& blur) {
    begin({shades_.id()}, 0, options_.width, options_.height);
    Inputs inputs(shade);
    inputs.set("surface", surface_);
    inputs.set("distance", distance_);
    inputs.set("shadow_map", shadow_map_);
    inputs.set("light_from_view", light_axes());
    inputs.set("eye", camera_.eye);
    inputs.set("slope", camera_.tan_half_height * aspect_, camera_.tan_half_height);
    inputs.set("up", up());
    inputs.set("ground", shapes_.ground);
    draw_screen();
    const gl::Texture half_way = gl::make_texture(GL_RG16F, options_.width, options_.height);
    blur_along(blur, shades_, half_way, 1.0 / options_.width, 0);
    blur_along(blur, half_way, shades_, 0, 1.0 / options_.height);
  }

  void light(const gl::Program& program) {
    begin({color_.id()}, 0, width_, height_);
    Inputs inputs(program);
    inputs.set("albedo", albedo_);
    inputs.set("surface", surface_);
    inputs.set("distance", distance_);
    inputs.set("shades", shades_);
    inputs.set("slope", camera_.tan_half_height * aspect_, camera_.tan_half_height);
    inputs.set("up", up());
    inputs.set("key", Vec3(light_axes().row(2)));
    inputs.set("background", background_colors(options_.background));
    inputs.set("strength", options_.ambient_occlusion ? 1.4 : 0.0, options_.shadows ? 1.0 : 0.0);
    draw_screen();
  }

  void draw_cage_faces(const gl::Program& distance, const gl::Program& face) {
    const gl::Elements faces(sorted_by_depth(shapes_.faces, camera_),
                             {{0, 3, GL_FLOAT, offsetof(FaceVertex, position)},
                              {1, 4, GL_UNSIGNED_BYTE, offsetof(FaceVertex, color)}});
    begin({cage_distance_.id()}, depth_.id(), width_, height_);
    constexpr std::array<float, 4> far = {nothing_there, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, far.data());
    glClear(GL_DEPTH_BUFFER_BIT);
    Inputs(distance).set(camera_, aspect_);
    with_depth_test([&] { faces.draw(); });

    begin({color_.id()}, 0, width_, height_);
    Inputs inputs(face);
    inputs.set(camera_, aspect_);
    inputs.set("model_distance", distance_);
    inputs.set("opacity", options_.cage_opacity);
    blend([&] { faces.draw(); });
  }

  void draw_lines(const gl::Program& program, const std::vector<LineInstance>& lines, double width,
                  const Vec3& strength) {
    begin({color_.id()}, 0, width_, height_);
    Inputs inputs(program);
    set_marks(inputs, width / 2, strength);
    const gl::Elements elements(lines,
                                {{0, 3, GL_FLOAT, offsetof(LineInstance, begin)},
                                 {1, 3, GL_FLOAT, offsetof(LineInstance, end)},
                                 {2, 4, GL_UNSIGNED_BYTE, offsetof(LineInstance, color)}},
                                true);
    blend([&] { elements.draw(); });
  }

  void draw_dots(const gl::Program& program, const Vec3& strength) {
    if (options_.vertex_radius == 0) {
      return;
    }
    begin({color_.id()}, 0, width_, height_);
    Inputs inputs(program);
    set_marks(inputs, options_.vertex_radius, strength);
    const gl::Elements elements(shapes_.dots,
                                {{0, 3, GL_FLOAT, offsetof(DotInstance, position)},
                                 {1, 4, GL_UNSIGNED_BYTE, offsetof(DotInstance, color)}},
                                true);
    blend([&] { elements.draw(); });
  }

  [[nodiscard]] Image resolve(const gl::Program& program) {
    const gl::Texture result = gl::make_texture(GL_RGBA8, options_.width, options_.height);
    begin({result.id()}, 0, options_.width, options_.height);
    Inputs inputs(program);
    inputs.set("samples", color_);
    inputs.set("count", options_.samples);
    draw_screen();

    Image image{options_.width, options_.height, {}};
    std::vector<Pixel> upward(static_cast<std::size_t>(options_.width) *
                              static_cast<std::size_t>(options_.height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, options_.width, options_.height, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
    image.pixels.reserve(upward.size());
    for (int y = options_.height; y-- > 0;) {
      const auto row = upward.begin() + static_cast<std::ptrdiff_t>(y) * options_.width;
      image.pixels.insert(image.pixels.end(), row, row + options_.width);
    }
    return image;
  }

private:
  void begin(const std::vector<GLuint>& colors, GLuint depth, int width, int height) {
    target_ = gl::make_framebuffer(colors, depth);
    glViewport(0, 0, width, height);
  }

  static void draw_screen() {
    GLuint id = 0;
    glGenVertexArrays(1, &id);
    const gl::VertexArray empty(id); // the vertices come from their numbers alone
    glBindVertexArray(id);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  [[nodiscard]] Vec3 up() const { return camera_.axes.col(options_.up == UpAxis::y ? 1 : 2); }

  template <class Draw> static void with_depth_test(const Draw& draw) {
    glEnable(GL_DEPTH_TEST);
    draw();
    glDisable(GL_DEPTH_TEST);
  }

  template <class Draw> static void blend(const Draw& draw) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw();
    glDisable(GL_BLEND);
  }

  void blur_along(const gl::Program& program, const gl::Texture& from, const gl::Texture& to,
                  double x, double y) {
    begin({to.id()}, 0, options_.width, options_.height);
    Inputs inputs(program);
    inputs.set("shades", from);
    inputs.set("distance", distance_);
    inputs.set("step_size", x, y);
    draw_screen();
  }

  void set_marks(Inputs& inputs, double radius, const Vec3& strength) {
    inputs.set(camera_, aspect_);
    inputs.set("frame", width_, height_);
    inputs.set("radius", radius * options_.samples);
    inputs.set("samples", static_cast<double>(options_.samples));
    inputs.set("strength", strength);
    inputs.set("model_distance", distance_);
    inputs.set("cage_distance", cage_distance_);
  }

  const Shapes& shapes_;
  const gl::Elements& solids_;
  const Camera& camera_;
  const RenderOptions& options_;
  int width_; // in samples
  int height_;
  double aspect_;
  gl::Texture albedo_;
  gl::Texture surface_;
  gl::Texture distance_;
  gl::Texture depth_;
  gl::Texture cage_distance_;
  gl::Texture shadow_map_;
  gl::Texture shades_;
  gl::Texture color_;
  gl::Framebuffer target_;
};

std::vector<Camera> cameras_at_one_scale(std::span<const View> views, const Shapes& shapes,
                                         const RenderOptions& options) {
  std::vector<Camera> cameras;
  double distance = 0;
  const double aspect = static_cast<double>(options.width) / options.height;
  for (const View& view : views) {
    cameras.push_back(fitted_camera(view, options.up, options.angle_degrees, aspect, options.margin,
                                    shapes.points));
    distance = std::max(distance, cameras.back().eye.z());
  }
  for (Camera& camera : cameras) {
    const double back = distance - camera.eye.z();
    camera.eye.z() += back;
    camera.nearest += back;
    camera.farthest += back;
  }
  return cameras;
}

} // namespace

Renderer::Renderer(std::unique_ptr<Programs> programs) : programs_(std::move(programs)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create() {
  Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
  if (!context) {
    return context.error();
  }
  auto programs = std::make_unique<Programs>();
  programs->context = std::move(*context);
  const gl::Context::Use use(*programs->context);

  using namespace shaders;
  const std::string with_camera = camera;
  const std::string with_hidden = hidden_function;
  const std::string screen = screen_vertex;
  const struct {
    gl::Program& program;
    std::string vertex, fragment;
  } sources[] = {
      {programs->solid, with_camera + solid_vertex, solid_fragment},
      {programs->shadow, shadow_vertex, shadow_fragment},
      {programs->shade, screen, shade_fragment},
      {programs->blur, screen, blur_fragment},
      {programs->light, screen, light_fragment},
      {programs->resolve, screen, resolve_fragment},
      {programs->face, with_camera + face_vertex, face_fragment},
      {programs->face_distance, with_camera + face_vertex, distance_fragment},
      {programs->line, with_camera + line_vertex, with_hidden + line_fragment},
      {programs->dot, with_camera + dot_vertex, with_hidden + dot_fragment},
  };
  for (const auto& source : sources) {
    Result<gl::Program> made = gl::make_program(source.vertex, source.fragment);
    if (!made) {
      return made.error();
    }
    source.program = std::move(*made);
  }
  return Renderer(std::move(programs));
}

Result<Image> Renderer::render(const Scene& scene, const RenderOptions& options) {
  return render(scene, std::span(&options.view, 1), options);
}

Result<Image> Renderer::render(const Scene& scene, std::span<const View> views,
                               const RenderOptions& asked) {
  if (const Status fit = check_options(scene, views.size(), asked); !fit) {
    return fit.error();
  }
  const Result<Normalization> normalization = normalization_of(scene);
  if (!normalization) {
    return normalization.error();
  }
  const gl::Context::Use use(*programs_->context);
  const Result<int> samples = samples_within_memory(asked);
  if (!samples) {
    return samples.error();
  }
  RenderOptions options = asked;
  options.samples = *samples;
  const Shapes shapes = shapes_of(scene, *normalization, options);

  const gl::Elements solids(shapes.solids,
                            {{0, 3, GL_FLOAT, offsetof(SolidVertex, position)},
                             {1, 3, GL_FLOAT, offsetof(SolidVertex, normal)},
                             {2, 4, GL_UNSIGNED_BYTE, offsetof(SolidVertex, color)}});
  std::vector<Image> images;
  for (const Camera& camera : cameras_at_one_scale(views, shapes, options)) {
    Drawing drawing(shapes, solids, camera, options);
    drawing.draw_solids(programs_->solid);
    drawing.draw_shadow_map(programs_->shadow);
    drawing.find_shades(programs_->shade, programs_->blur);
    drawing.light(programs_->light);
    drawing.draw_lines(programs_->line, shapes.fine_lines, 1.0, {1, 1, 0});
    drawing.draw_cage_faces(programs_->face_distance, programs_->face);
    drawing.draw_lines(programs_->line, shapes.lines, options.edge_width, {1, 0.45, 0.22});
    drawing.draw_dots(programs_->dot, {1, 0.5, 0.15});
    images.push_back(drawing.resolve(programs_->resolve));
  }
  return side_by_side(images);
}

Result<Image> render(const Scene& scene, const RenderOptions& options) {
  Result<Renderer> renderer = Renderer::create();
  if (!renderer) {
    return renderer.error();
  }
  return renderer->render(scene, options);
}

} // namespace cagewright
