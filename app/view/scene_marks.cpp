#include "app/view/scene_marks.h"

#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace cagewright::app {
namespace {

// Edges that turn away from the viewer are drawn this strong.
constexpr double behind = 0.35;

Rgb mixed(const Rgb& a, const Rgb& b, float t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

Vec3 face_normal(const PolygonMesh& cage, Index f) {
  const std::span<const Index> face = cage.face(f);
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    normal += (cage.positions[face[k]] - cage.positions[face[0]])
                  .cross(cage.positions[face[k + 1]] - cage.positions[face[0]]);
  }
  return normal;
}

void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Color& color,
                  std::vector<FaceMark>& faces) {
  faces.push_back({{a, b, c}, {color, color, color}});
}

void add_quad(const std::array<Vec3, 4>& q, const Color& color, std::vector<FaceMark>& faces) {
  add_triangle(q[0], q[1], q[2], color, faces);
  add_triangle(q[0], q[2], q[3], color, faces);
}

void add_box(const OrientedBox& box, const Rgb& color, double opacity, double width, Marks& marks) {
  const std::array<Vec3, 8> c = box.corners();
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const int j = i | 1 << axis;
      if (j != i) {
        marks.lines.push_back({c[i], c[j], color_of(color), static_cast<float>(width)});
      }
    }
  }
  const Color faces = color_of(color, opacity);
  const std::array<std::array<int, 4>, 6> sides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& s : sides) {
    add_quad({c[s[0]], c[s[1]], c[s[2]], c[s[3]]}, faces, marks.faces);
  }
}

/// 1, 2 or 5 times a power of ten, near to the value.
double round_step(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double lead = value / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

Vec3 on_screen(const Pixel& p) {
  return {p.x(), p.y(), 0};
}

} // namespace

ViewColors ViewColors::light() {
  return {.top = {0.945F, 0.950F, 0.955F},
          .bottom = {0.815F, 0.830F, 0.850F},
          .model = {0.76F, 0.725F, 0.675F},
          .wire = {0.12F, 0.12F, 0.14F},
          .cage = {0.10F, 0.27F, 0.55F},
          .cage_face = {0.25F, 0.50F, 0.90F},
          .selected = {0.96F, 0.52F, 0.05F},
          .hovered = {1.0F, 0.75F, 0.25F},
          .bad = {0.88F, 0.10F, 0.12F},
          .grid = {0.52F, 0.55F, 0.60F},
          .text = {0.16F, 0.18F, 0.22F}};
}

ViewColors ViewColors::dark() {
  return {.top = {0.230F, 0.240F, 0.255F},
          .bottom = {0.125F, 0.130F, 0.140F},
          .model = {0.66F, 0.635F, 0.60F},
          .wire = {0.03F, 0.03F, 0.04F},
          .cage = {0.55F, 0.75F, 1.0F},
          .cage_face = {0.35F, 0.60F, 1.0F},
          .selected = {1.0F, 0.62F, 0.15F},
          .hovered = {1.0F, 0.84F, 0.45F},
          .bad = {1.0F, 0.25F, 0.25F},
          .grid = {0.42F, 0.44F, 0.48F},
          .text = {0.90F, 0.91F, 0.93F}};
}

Rgb weight_rgb(float weight) {
  struct Stop {
    float weight;
    Rgb color;
  };
  // Two hues that part at a light grey, also told apart by those who see no red or no green.
  static constexpr std::array<Stop, 6> stops = {{{least_weight, {0.10F, 0.20F, 0.60F}},
                                                 {-0.15F, {0.40F, 0.58F, 0.88F}},
                                                 {0.0F, {0.86F, 0.86F, 0.85F}},
                                                 {0.25F, {0.98F, 0.78F, 0.40F}},
                                                 {0.6F, {0.93F, 0.45F, 0.16F}},
                                                 {1.0F, {0.65F, 0.05F, 0.10F}}}};
  const float w = std::clamp(weight, stops.front().weight, stops.back().weight);
  std::size_t i = 1;
  while (i + 1 < stops.size() && w > stops[i].weight) {
    ++i;
  }
  return mixed(stops[i - 1].color, stops[i].color,
               (w - stops[i - 1].weight) / (stops[i].weight - stops[i - 1].weight));
}

Color weight_color(float weight) {
  return color_of(weight_rgb(weight));
}

Color density_color(float density, const Rgb& model) {
  static constexpr Rgb finer = {0.86F, 0.16F, 0.14F};
  static constexpr Rgb coarser = {0.16F, 0.34F, 0.88F};
  return color_of(mixed(model, density > 0 ? finer : coarser, std::min(1.0F, std::abs(density))));
}

Rgb share_rgb(float share, const Rgb& model) {
  static constexpr Rgb other = {0.93F, 0.52F, 0.08F};
  return mixed(model, other, std::clamp(share, 0.0F, 1.0F));
}

Color share_color(float share, const Rgb& model) {
  return color_of(share_rgb(share, model));
}

Color distance_color(float distance) {
  constexpr float full = 0.08F;
  return color_of(scale_color(std::min(1.0F, distance / full)));
}

Rgb axis_color(int axis) {
  static constexpr std::array<Rgb, 3> colors = {
      {{0.90F, 0.24F, 0.26F}, {0.36F, 0.68F, 0.16F}, {0.20F, 0.46F, 0.92F}}};
  return colors[static_cast<std::size_t>(axis)];
}

void add_cage(const Document& document, const PolygonMesh& cage, const CageGraph& graph,
              const OrbitCamera& camera, const ViewColors& colors,
              const std::optional<Pick>& hovered, Marks& marks) {
  const Layers& layers = document.layers();
  const Selection& selection = document.selection();
  const std::span<const Index> offending = document.offending_faces();
  std::vector<char> bad(cage.face_count(), 0);
  for (const Index f : offending) {
    if (f < bad.size() && layers.problems) {
      bad[f] = 1;
    }
  }
  std::vector<char> selected_face(cage.face_count(), 0);
  for (const Index f : selection.faces) {
    selected_face[f] = 1;
  }
  std::vector<char> faces_viewer(cage.face_count(), 0);
  for (Index f = 0; f < cage.face_count(); ++f) {
    const Vec3& corner = cage.positions[cage.face(f)[0]];
    faces_viewer[f] = face_normal(cage, f).dot(camera.to_viewer(corner)) > 0 ? 1 : 0;
  }
  const bool hovers_face = hovered && hovered->mode == SelectionMode::face;
  const std::span<const float> distances = document.cage_distances();
  const bool by_distance = layers.distance && distances.size() == cage.positions.size();

  const InSight sight(graph, document.state().hidden_faces);
  const Triangulation cut = triangulate(cage);
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const Index f = cut.face_of[t];
    if (!sight.face(f)) {
      continue;
    }
    const bool is_hovered = hovers_face && hovered->element == f;
    const bool is_marked = bad[f] != 0 || selected_face[f] != 0 || is_hovered;
    if (!layers.cage_faces && !is_marked) {
      continue;
    }
    const Color color = bad[f] != 0             ? color_of(colors.bad, 0.55)
                        : selected_face[f] != 0 ? color_of(colors.selected, is_hovered ? 0.6 : 0.45)
                        : is_hovered            ? color_of(colors.hovered, 0.3)
                                                : color_of(colors.cage_face, 0.11);
    FaceMark mark{{}, {color, color, color}};
    for (int k = 0; k < 3; ++k) {
      const Index v = cut.triangles[t][k];
      mark.corners[k] = cage.positions[v];
      if (by_distance && !is_marked) {
        mark.colors[k] = distance_color(distances[v]);
        mark.colors[k][3] = 190;
      }
    }
    marks.faces.push_back(mark);
  }

  std::vector<char> front_vertex(cage.positions.size(), 0);
  for (Index f = 0; f < cage.face_count(); ++f) {
    if (faces_viewer[f] != 0) {
      for (const Index v : cage.face(f)) {
        front_vertex[v] = 1;
      }
    }
  }
  std::vector<char> selected_vertex(cage.positions.size(), 0);
  for (const Index v : selection.vertices) {
    selected_vertex[v] = 1;
  }
  const bool hovers_edge = hovered && hovered->mode == SelectionMode::edge;
  std::vector<LineMark> raised; // drawn after the others
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const EdgeVertices& edge = graph.edge(e);
    const std::span<const Index> round = graph.edge_faces(e);
    const bool front =
        std::any_of(round.begin(), round.end(), [&](Index f) { return faces_viewer[f] != 0; });
    const bool is_bad =
        std::any_of(round.begin(), round.end(), [&](Index f) { return bad[f] != 0; });
    const bool is_selected =
        std::binary_search(selection.edges.begin(), selection.edges.end(), edge) ||
        (selected_vertex[edge[0]] != 0 && selected_vertex[edge[1]] != 0) ||
        std::any_of(round.begin(), round.end(), [&](Index f) { return selected_face[f] != 0; });
    const bool is_hovered = hovers_edge && hovered->element == e;
    if (!sight.edge(e) || (!layers.cage_edges && !is_selected && !is_hovered && !is_bad)) {
      continue;
    }
    const Rgb rgb = is_hovered    ? colors.hovered
                    : is_selected ? colors.selected
                    : is_bad      ? colors.bad
                                  : colors.cage;
    LineMark line{cage.positions[edge[0]], cage.positions[edge[1]],
                  color_of(rgb, front ? 0.95 : behind), front ? 1.7F : 1.2F};
    if (is_selected || is_hovered) {
      line.width = 2.6F;
      raised.push_back(line);
    } else {
      marks.lines.push_back(line);
    }
  }
  marks.lines.insert(marks.lines.end(), raised.begin(), raised.end());

  const bool small_dots = selection.mode != SelectionMode::vertex;
  std::vector<DotMark> raised_dots;
  for (Index v = 0; v < cage.positions.size(); ++v) {
    const bool is_hovered =
        hovered && hovered->mode == SelectionMode::vertex && hovered->element == v;
    const bool is_selected = selected_vertex[v] != 0;
    if (graph.vertex_faces(v).empty() || !sight.vertex(v) ||
        (!layers.cage_vertices && !is_selected && !is_hovered)) {
      continue;
    }
    const double strength = front_vertex[v] != 0 ? 1 : behind;
    if (is_selected || is_hovered) {
      raised_dots.push_back({cage.positions[v],
                             color_of(is_hovered && !is_selected ? colors.hovered : colors.selected,
                                      std::max(strength, 0.6)),
                             is_hovered ? 5.8F : 4.8F});
    } else if (!small_dots) {
      marks.dots.push_back({cage.positions[v], color_of(colors.cage, strength), 3.4F});
    }
  }
  marks.dots.insert(marks.dots.end(), raised_dots.begin(), raised_dots.end());
}

void add_rest(const Document& document, const CageGraph& graph, const ViewColors& colors,
              Marks& marks) {
  const std::vector<Vec3>& rest = document.cage_rest().positions;
  for (const EdgeVertices& e : graph.edges()) {
    if (e[1] < rest.size()) {
      marks.lines.push_back({rest[e[0]], rest[e[1]], color_of(colors.text, 0.28), 1.2F});
    }
  }
}

void add_boxes(const Document& document, Marks& marks) {
  const Layers& layers = document.layers();
  const BoxDecomposition& stages = *document.stages();
  const BoxTree& tree = stages.tree;
  std::size_t number = 0;
  if (layers.boxes) {
    for (const int node : tree.cover(layers.depth)) {
      const bool is_selected = node == layers.selected_box;
      add_box(stages.to_model(tree.nodes[static_cast<std::size_t>(node)].box),
              group_color(number++), is_selected ? 0.4 : 0.14, is_selected ? 3 : 1.6, marks);
    }
  }
  if (layers.selected_box >= 0 && !layers.boxes &&
      static_cast<std::size_t>(layers.selected_box) < tree.nodes.size()) {
    add_box(stages.to_model(tree.nodes[static_cast<std::size_t>(layers.selected_box)].box),
            {0.95F, 0.55F, 0.10F}, 0.2, 2.4, marks);
  }
  if (!layers.cuts) {
    return;
  }
  // The plane of each cut that was made to come to the boxes shown, where it goes through its box.
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const BoxNode& node = tree.nodes[i];
    if (!node.cut || (layers.depth >= 0 && node.depth >= layers.depth)) {
      continue;
    }
    const OrientedBox box = stages.to_model(node.box);
    const int axis = node.cut->plane.axis;
    const Vec3 middle =
        box.center + box.axes.col(axis) * (node.cut->plane.offset * stages.voxel_size());
    const Vec3 u = box.axes.col((axis + 1) % 3) * box.half[(axis + 1) % 3];
    const Vec3 v = box.axes.col((axis + 2) % 3) * box.half[(axis + 2) % 3];
    const std::array<Vec3, 4> corners = {middle - u - v, middle + u - v, middle + u + v,
                                         middle - u + v};
    const Rgb color = group_color(static_cast<std::size_t>(node.depth));
    add_quad(corners, color_of(color, 0.22), marks.faces);
    for (std::size_t k = 0; k < 4; ++k) {
      marks.lines.push_back({corners[k], corners[(k + 1) % 4], color_of(color), 1.8F});
    }
  }
}

std::vector<FaceMark> voxel_faces(const BoxDecomposition& stages, bool feature, bool inner) {
  const VoxelGrid& grid = stages.grid;
  const auto is_shown = [&](int i, int j, int k) {
    if (i < 0 || j < 0 || k < 0 || i >= grid.dims[0] || j >= grid.dims[1] || k >= grid.dims[2]) {
      return false;
    }
    const VoxelKind kind = grid.kinds[grid.index(i, j, k)];
    return (feature && kind == VoxelKind::feature) || (inner && kind == VoxelKind::inner);
  };
  std::vector<FaceMark> faces;
  for (int k = 0; k < grid.dims[2]; ++k) {
    for (int j = 0; j < grid.dims[1]; ++j) {
      for (int i = 0; i < grid.dims[0]; ++i) {
        if (!is_shown(i, j, k)) {
          continue;
        }
        const bool is_feature = grid.kinds[grid.index(i, j, k)] == VoxelKind::feature;
        const Color color =
            is_feature ? color_of({0.90F, 0.66F, 0.30F}) : color_of({0.40F, 0.62F, 0.82F});
        for (int axis = 0; axis < 3; ++axis) {
          for (const int side : {0, 1}) {
            std::array<int, 3> next = {i, j, k};
            next[axis] += side == 1 ? 1 : -1;
            if (is_shown(next[0], next[1], next[2])) {
              continue;
            }
            const auto corner = [&](int du, int dv) {
              Vec3 p(i, j, k);
              p[axis] += side;
              p[(axis + 1) % 3] += du;
              p[(axis + 2) % 3] += dv;
              return stages.to_model(p);
            };
            add_quad({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, color, faces);
          }
        }
      }
    }
  }
  return faces;
}

void add_problems(const Document& document, const ViewColors& colors, Marks& marks) {
  const CageCheck& check = document.check();
  if (!check.report) {
    return;
  }
  for (const Violation& v : check.report->violations) {
    if (v.place.allFinite() && v.kind != ViolationKind::no_faces) {
      marks.dots.push_back({v.place, color_of(colors.bad, 0.25), 9});
      marks.dots.push_back({v.place, color_of(colors.bad), 4});
    }
  }
}

void add_grid(const Box3& bounds, const OrbitCamera& camera, const ViewColors& colors,
              Marks& marks) {
  if (bounds.isEmpty()) {
    return;
  }
  const int up = camera.up() == UpAxis::y ? 1 : 2;
  const int u = up == 1 ? 0 : 0;
  const int v = up == 1 ? 2 : 1;
  const double size = bounds.diagonal().norm();
  if (!(size > 0)) {
    return;
  }
  const double step = round_step(size / 10);
  const double ground = bounds.min()[up] - 0.002 * size;
  const Vec3 center = bounds.center();
  constexpr int reach = 10;
  const double u0 = std::round(center[u] / step);
  const double v0 = std::round(center[v] / step);
  for (int i = -reach; i <= reach; ++i) {
    for (const bool along_u : {true, false}) {
      // In pieces, fading towards the rim.
      for (int j = -reach; j < reach; ++j) {
        Vec3 a = Vec3::Constant(ground);
        Vec3 b = Vec3::Constant(ground);
        a[along_u ? u : v] = ((along_u ? u0 : v0) + j) * step;
        b[along_u ? u : v] = ((along_u ? u0 : v0) + j + 1) * step;
        a[along_u ? v : u] = b[along_u ? v : u] = ((along_u ? v0 : u0) + i) * step;
        const double r = std::hypot(i, j + 0.5) / reach;
        if (r < 1) {
          marks.ground.push_back({a, b, color_of(colors.grid, 0.5 * (1 - r * r)), 1.0F});
        }
      }
    }
  }
}

void add_gizmo(const OrbitCamera& camera, TransformKind kind, const GizmoFrame& frame,
               Handle hovered, Overlay& overlay) {
  for (const GizmoShape& shape : gizmo_shapes(camera, kind, frame)) {
    const bool is_hovered = shape.handle == hovered;
    const int axis = axis_of(shape.handle);
    const Rgb rgb = is_hovered  ? Rgb{1.0F, 0.80F, 0.15F}
                    : axis >= 0 ? axis_color(axis)
                                : Rgb{0.95F, 0.95F, 0.96F};
    std::vector<Vec3> line;
    for (const Vec3& p : shape.points) {
      const auto at = camera.project(p);
      if (!at) {
        line.clear();
        break;
      }
      line.push_back(on_screen(at->pixel));
    }
    if (line.size() < 2) {
      continue;
    }
    const bool is_ball = shape.handle == Handle::trackball;
    if (shape.filled) {
      const double opacity = is_ball                        ? (is_hovered ? 0.12 : 0.05)
                             : is_plane(shape.handle)       ? (is_hovered ? 0.75 : 0.4)
                             : shape.handle == Handle::view ? (is_hovered ? 0.55 : 0.22)
                                                            : 0.95;
      for (std::size_t k = 1; k + 1 < line.size(); ++k) {
        add_triangle(line[0], line[k], line[k + 1], color_of(rgb, opacity), overlay.faces);
      }
      if (is_ball) {
        continue;
      }
      line.push_back(line.front());
    }
    const bool is_tip = shape.filled && axis >= 0 && !is_plane(shape.handle);
    const float width = is_tip ? 1.0F : shape.filled ? 1.4F : is_hovered ? 3.6F : 2.6F;
    const bool is_rim = shape.handle == Handle::view;
    // A dark line under the light one keeps the gizmo readable on any background.
    for (std::size_t k = 0; k + 1 < line.size() && is_rim; ++k) {
      overlay.lines.push_back(
          {line[k], line[k + 1], color_of({0.1F, 0.1F, 0.12F}, 0.35), width + 1.6F});
    }
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      overlay.lines.push_back({line[k], line[k + 1], color_of(rgb, 0.95), width});
    }
  }
}

namespace {

constexpr double tripod_size = 34;

Pixel tripod_middle(const OrbitCamera& camera) {
  return {52, camera.height() - 52};
}

} // namespace

std::array<Pixel, 3> tripod_tips(const OrbitCamera& camera) {
  const Mat3 axes = camera.axes();
  std::array<Pixel, 3> tips;
  for (int i = 0; i < 3; ++i) {
    tips[static_cast<std::size_t>(i)] =
        tripod_middle(camera) + tripod_size * Pixel(axes(0, i), -axes(1, i));
  }
  return tips;
}

void add_tripod(const OrbitCamera& camera, Overlay& overlay) {
  const Mat3 axes = camera.axes();
  const std::array<Pixel, 3> tips = tripod_tips(camera);
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return axes(2, a) < axes(2, b); });
  for (const int i : order) {
    const Color color = color_of(axis_color(i), axes(2, i) < -0.2 ? 0.55 : 1);
    const Pixel& tip = tips[static_cast<std::size_t>(i)];
    overlay.lines.push_back({on_screen(tripod_middle(camera)), on_screen(tip), color, 2.2F});
    overlay.dots.push_back({on_screen(tip), color, 8});
  }
}

} // namespace cagewright::app
