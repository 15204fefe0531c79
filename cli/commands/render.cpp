#include "load.h"
#include "model_choice.h"
#include "session.h"

#include <cagewright/render/render.h>

#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cagewright::cli {
namespace {

struct RenderCommand {
  std::string model;
  ModelChoice choice;
  std::string cage;
  std::string output = "cagewright.png";
  std::string beside;
  std::vector<std::string> views = {"three-quarter"};
  std::string size = "1200x900";
  bool color_by_group = false;
  bool model_as_cage = false;
  bool no_occlusion = false;
  bool no_shadows = false;
  bool no_faces = false;
  RenderOptions options;
};

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                  : std::nullopt;
}

/// "YAW:PITCH", or a name.
std::optional<View> parse_view(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    return view_named(text);
  }
  const std::optional<double> yaw = number(std::string_view(text).substr(0, colon));
  const std::optional<double> pitch = number(std::string_view(text).substr(colon + 1));
  if (!yaw || !pitch) {
    return std::nullopt;
  }
  return View{*yaw, *pitch};
}

Result<std::vector<View>> parse_views(const std::vector<std::string>& texts) {
  std::vector<View> views;
  for (const std::string& text : texts) {
    const std::optional<View> view = parse_view(text);
    if (!view) {
      return Error{ErrorCode::invalid_option,
                   "--views: " + text +
                       " is neither front, back, left, right, side, top, bottom, three-quarter nor "
                       "YAW:PITCH in degrees"};
    }
    views.push_back(*view);
  }
  return views;
}

Status parse_size(const std::string& text, RenderOptions& options) {
  const std::size_t cross = text.find('x');
  const auto width = number(std::string_view(text).substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : number(std::string_view(text).substr(cross + 1));
  const auto fits = [](std::optional<double> n) { return n && *n >= 1 && *n <= 32768; };
  if (!fits(width) || !fits(height)) {
    return Error{ErrorCode::invalid_option, "--size: " + text + " is not WIDTHxHEIGHT in pixels"};
  }
  options.width = static_cast<int>(*width);
  options.height = static_cast<int>(*height);
  return success();
}

Result<Image> draw(RenderCommand& command) {
  const Result<std::vector<View>> views = parse_views(command.views);
  if (!views) {
    return views.error();
  }
  if (const Status size = parse_size(command.size, command.options); !size) {
    return size.error();
  }
  Scene scene;
  const Result<PolygonMesh> model = load_chosen(command.model, command.choice);
  if (!model) {
    return model.error();
  }
  scene.layers.push_back(command.model_as_cage ? Layer::cage(*model) : Layer::model(*model));
  scene.layers.back().color_by_group = command.color_by_group;

  std::optional<PolygonMesh> cage;
  if (!command.cage.empty()) {
    Result<PolygonMesh> read = load_cage(command.cage, command.choice);
    if (!read) {
      return read.error();
    }
    cage = std::move(*read);
    scene.layers.push_back(Layer::cage(*cage));
    scene.layers.back().color_by_group = command.color_by_group;
  }
  Result<Renderer> renderer = Renderer::create();
  if (!renderer) {
    return renderer.error();
  }
  command.options.ambient_occlusion = !command.no_occlusion;
  command.options.shadows = !command.no_shadows;
  command.options.cage_faces = !command.no_faces;
  return renderer->render(scene, *views, command.options);
}

Result<Image> draw_beside(RenderCommand& command) {
  if (command.beside.empty()) {
    return draw(command);
  }
  Result<Image> left = read_png(command.beside);
  if (!left) {
    return left;
  }
  Result<Image> right = draw(command);
  if (!right) {
    return right;
  }
  if (left->height != right->height) {
    return Error{ErrorCode::mismatch,
                 fmt::format("{} is {} pixels high, the new picture {}; give --size",
                             command.beside, left->height, right->height)};
  }
  return side_by_side({*left, *right});
}

int run(RenderCommand& command) {
  if (const Status writable =
          can_write_output(command.output, {command.model, command.cage, command.beside});
      !writable) {
    return fail(writable.error());
  }
  const Result<Image> image = draw_beside(command);
  if (!image) {
    return fail(image.error());
  }
  if (const Status written = write_png(*image, command.output); !written) {
    return fail(written.error());
  }
  return done;
}

} // namespace

void add_render(CLI::App& app, Session& session) {
  auto command = std::make_shared<RenderCommand>();
  RenderOptions& options = command->options;
  CLI::App* sub =
      app.add_subcommand("render", "Draw a model, and a cage over it, as a PNG picture");
  sub->add_option("model", command->model, "The model")->required();
  sub->add_option("cage", command->cage, "A cage to draw over it");
  add_pose_option(*sub, command->choice);
  add_only_option(*sub, command->choice, "Draw this object or group of the model only");
  add_cage_object_option(*sub, command->choice);
  sub->add_option("-o,--output", command->output, "The picture to write");
  sub->add_option("--beside", command->beside,
                  "A PNG picture of the same height: the new one is joined to its right");
  sub->add_option("--views,--view", command->views,
                  "Sides to draw next to each other: front, back, left, right, side, top, bottom, "
                  "three-quarter, or YAW:PITCH in degrees; separated by commas")
      ->delimiter(',');
  sub->add_option("--size", command->size, "Width and height of each view in pixels");
  sub->add_option("--up", options.up, "The model's up axis: y or z")
      ->transform(CLI::CheckedTransformer(
          std::vector<std::pair<std::string, UpAxis>>{{"y", UpAxis::y}, {"z", UpAxis::z}}))
      ->option_text("y|z=y");
  sub->add_option("--background", options.background, "gradient, white or transparent")
      ->transform(CLI::CheckedTransformer(std::vector<std::pair<std::string, Background>>{
          {"gradient", Background::gradient},
          {"white", Background::white},
          {"transparent", Background::transparent}}))
      ->option_text("NAME=gradient");
  sub->add_flag("--color-by-group", command->color_by_group,
                "A color for each object of the files, such as the boxes of --emit boxes");
  sub->add_flag("--glass", command->model_as_cage, "Draw the model itself as a cage is drawn");
  sub->add_flag("--model-edges", options.model_edges, "Draw the edges of the model's polygons");
  sub->add_flag("--no-cage-faces", command->no_faces, "Draw only the lines and dots of the cage");
  sub->add_flag("--no-ambient-occlusion", command->no_occlusion, "Do not darken folds");
  sub->add_flag("--no-shadows", command->no_shadows, "Do not draw shadows");
  sub->add_option("--cage-opacity", options.cage_opacity, "Opacity of the cage's faces, 0 to 1");
  sub->add_option("--edge-width", options.edge_width, "Width of the cage's lines in pixels");
  sub->add_option("--vertex-radius", options.vertex_radius,
                  "Radius of the cage's dots in pixels; 0 for none");
  sub->add_option("--least-bend-degrees", options.least_bend_degrees,
                  "Leave out lines of the cage where its faces bend less");
  sub->add_option("--crease-degrees", options.crease_degrees,
                  "Edges of the model that bend more are drawn sharp");
  sub->add_option("--angle-degrees", options.angle_degrees, "Height of the angle of view");
  sub->add_option("--margin", options.margin, "Free space at each side, fraction of the picture");
  sub->add_option("--samples", options.samples, "Samples across and down each pixel, 1 to 4");
  sub->callback([command, &session] { session.run = [command] { return run(*command); }; });
}

} // namespace cagewright::cli
