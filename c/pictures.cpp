#include "arrays.h"
#include "calls.h"

#include <cagewright/version.h>
#if CAGEWRIGHT_BUILD_RENDER
#include <cagewright/render/render.h>
#endif

#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace cagewright;
using namespace cagewright::c;

#if CAGEWRIGHT_BUILD_RENDER

struct cw_image {
  Image image;
};

namespace {

Result<RenderOptions> options_of(const cw_render_options& given) {
  constexpr int most = 32768;
  RenderOptions options;
  options.width = given.width != 0 ? given.width : options.width;
  options.height = given.height != 0 ? given.height : options.height;
  if (options.width < 1 || options.width > most || options.height < 1 || options.height > most) {
    return Error{ErrorCode::invalid_option, "a picture of " + std::to_string(options.width) +
                                                " x " + std::to_string(options.height) +
                                                " pixels; each side has 1 to 32768"};
  }
  if (given.background < 0 || given.background > 2) {
    return Error{ErrorCode::invalid_option,
                 "there is no background " + std::to_string(given.background) + "; give 0, 1 or 2"};
  }
  options.up = given.z_up != 0 ? UpAxis::z : UpAxis::y;
  options.background = given.background == 1   ? Background::white
                       : given.background == 2 ? Background::transparent
                                               : Background::gradient;
  options.shadows = given.no_shadows == 0;
  options.ambient_occlusion = given.no_ambient_occlusion == 0;
  options.model_edges = given.model_edges != 0;
  options.cage_faces = given.no_cage_faces == 0;
  return options;
}

Result<std::vector<View>> views_of(const cw_render_options& given) {
  std::vector<View> views;
  if (given.view_count > 0) {
    if (const Status there = all_given({{given.views, "the list of views"}}); !there) {
      return there.error();
    }
  }
  for (std::size_t i = 0; i < given.view_count; ++i) {
    views.push_back({given.views[2 * i], given.views[2 * i + 1]});
  }
  if (views.empty()) {
    views.push_back(*view_named("three-quarter"));
  }
  return views;
}

Status draw(const cw_mesh_view* model, const cw_mesh_view* cage, const cw_render_options& given,
            cw_image** out) {
  const Result<RenderOptions> options = options_of(given);
  if (!options) {
    return options.error();
  }
  const Result<std::vector<View>> views = views_of(given);
  if (!views) {
    return views.error();
  }
  const Result<MeshArgument> solid = MeshArgument::of(model, "the model");
  if (!solid) {
    return solid.error();
  }
  const PolygonMesh solid_faces = solid->polygons();
  Scene scene{{Layer::model(solid_faces)}};
  PolygonMesh cage_faces;
  if (cage != nullptr) {
    const Result<MeshArgument> wires = MeshArgument::of(cage, "the cage");
    if (!wires) {
      return wires.error();
    }
    cage_faces = wires->polygons();
    scene.layers.push_back(Layer::cage(cage_faces));
  }
  Result<Renderer> renderer = Renderer::create();
  if (!renderer) {
    return renderer.error();
  }
  Result<Image> image = renderer->render(scene, *views, *options);
  if (!image) {
    return image.error();
  }
  *out = new cw_image{std::move(*image)};
  return success();
}

} // namespace

int cw_view_named(const char* name, double yaw_pitch[2]) {
  if (name == nullptr || yaw_pitch == nullptr) {
    return 0;
  }
  const std::optional<View> view = view_named(name);
  if (view) {
    yaw_pitch[0] = view->yaw_degrees;
    yaw_pitch[1] = view->pitch_degrees;
  }
  return view ? 1 : 0;
}

size_t cw_image_width(const cw_image* image) {
  return image != nullptr ? static_cast<size_t>(image->image.width) : 0;
}

size_t cw_image_height(const cw_image* image) {
  return image != nullptr ? static_cast<size_t>(image->image.height) : 0;
}

const uint8_t* cw_image_pixels(const cw_image* image) {
  return image != nullptr ? image->image.pixels.front().data() : nullptr;
}

cw_code cw_image_write_png(const cw_image* image, const char* path, cw_error** error) {
  return call(error, [&] {
    const Status given = all_given({{image, "the picture"}, {path, "the path"}});
    return given ? write_png(image->image, path) : given;
  });
}

cw_code cw_render(const cw_mesh_view* model, const cw_mesh_view* cage,
                  const cw_render_options* options, cw_image** out, cw_error** error) {
  return call_for(out, error, nullptr,
                  [&](const Progress&) { return draw(model, cage, known_part(options), out); });
}

#else // the same functions, to say that there are no pictures

struct cw_image {};

namespace {

Status no_pictures() {
  return Error{ErrorCode::not_available, "this library was built without pictures; build it with "
                                         "-DCAGEWRIGHT_BUILD_RENDER=ON"};
}

} // namespace

int cw_view_named(const char*, double[2]) {
  return 0;
}

size_t cw_image_width(const cw_image*) {
  return 0;
}

size_t cw_image_height(const cw_image*) {
  return 0;
}

const uint8_t* cw_image_pixels(const cw_image*) {
  return nullptr;
}

cw_code cw_image_write_png(const cw_image*, const char*, cw_error** error) {
  return call(error, no_pictures);
}

cw_code cw_render(const cw_mesh_view*, const cw_mesh_view*, const cw_render_options*,
                  cw_image** out, cw_error** error) {
  return call_for(out, error, no_pictures);
}

#endif

void cw_image_free(cw_image* image) {
  delete image;
}
