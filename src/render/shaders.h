/// \file
/// The renderer's programs for the graphics card, in GLSL. Private to the module.
///
/// All distances are in units of the scene's radius. "View space" has x to the right, y up, z
/// towards the viewer, the eye at the origin. Colours are in linear light; a colour with opacity is
/// multiplied by it.
#pragma once

namespace cagewright::shaders {

/// The camera, for all vertex shaders.
inline constexpr const char* camera = R"(
uniform mat3 axes;       // rows: right, up, backward
uniform vec3 eye;        // along these
uniform vec2 slope;      // tangents of half the angles of view
uniform vec2 depth_range;
vec3 to_view(vec3 p) { return axes * p - eye; }
vec4 to_clip(vec3 v) {
  float n = depth_range.x, f = depth_range.y;
  return vec4(v.xy / slope, (v.z * (f + n) + 2 * f * n) / (n - f), -v.z);
}
)";

// ---- solids: what is seen at each sample, to be lit later

inline constexpr const char* solid_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
out vec3 view_position;
out vec3 view_normal;
out vec3 srgb;
void main() {
  view_position = to_view(position);
  view_normal = axes * normal;
  srgb = color.rgb;
  gl_Position = to_clip(view_position);
}
)";

inline constexpr const char* solid_fragment = R"(
in vec3 view_position;
in vec3 view_normal;
in vec3 srgb;
layout(location = 0) out vec4 albedo;  // sRGB; opacity 1
layout(location = 1) out vec4 surface; // unit normal towards the viewer
layout(location = 2) out float distance;
void main() {
  vec3 n = gl_FrontFacing ? view_normal : -view_normal;
  if (dot(n, n) < 0.25) { // opposite faces that share a vertex: fall back to the flat normal
    n = cross(dFdx(view_position), dFdy(view_position));
  }
  albedo = vec4(srgb, 1);
  surface = vec4(normalize(n), 0);
  distance = -view_position.z;
}
)";

// ---- full-screen passes

inline constexpr const char* screen_vertex = R"(
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2;
  gl_Position = vec4(uv * 2 - 1, 0, 1);
}
)";

/// Only how far the surface reaches towards the main light, seen from there.
inline constexpr const char* shadow_vertex = R"(
layout(location = 0) in vec3 position;
uniform mat3 light_axes; // rows: right and up as the light sees it, towards the light
out float height;
void main() {
  vec3 p = light_axes * position;
  height = p.z;
  gl_Position = vec4(p.xy, -p.z, 1);
}
)";

inline constexpr const char* shadow_fragment = R"(
in float height;
out float nearest;
void main() { nearest = height; }
)";

/// How much of the sky each point sees, judged from the depths round it in the picture, and how
/// much of the main light. Where there is no surface, the same light for the ground.
inline constexpr const char* shade_fragment = R"(
in vec2 uv;
uniform sampler2D surface;
uniform sampler2D distance;
uniform sampler2D shadow_map;
uniform mat3 light_from_view;
uniform vec3 eye;
uniform vec2 slope;
uniform vec3 up;
uniform float ground; // height of the ground
out vec2 shade;       // share of the sky, share of the light

const int SKY_RAYS = 24;
const int LIGHT_RAYS = 20;
const float GOLDEN = 2.39996323;
const float REACH = 0.24;

vec3 view_position(vec2 at, float depth) { return vec3((at * 2 - 1) * slope, -1) * depth; }

// Turns the patterns of rays from pixel to pixel (interleaved gradient noise).
float turn() {
  return 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
}

float open_sky(vec3 p, vec3 n) {
  vec3 side = normalize(cross(n, abs(n.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  vec3 other = cross(n, side);
  float first = turn();
  float blocked = 0;
  for (int i = 0; i < SKY_RAYS; ++i) {
    float t = (float(i) + 0.5) / SKY_RAYS;
    float angle = first + GOLDEN * float(i);
    float reach = REACH * mix(0.06, 1.0, t * fract(float(i) * 0.7548777 + 0.3));
    vec3 q = p + reach * (sqrt(t) * (cos(angle) * side + sin(angle) * other) + sqrt(1 - t) * n);
    float seen = texture(distance, q.xy / (-q.z * slope) * 0.5 + 0.5).r;
    float before = -q.z - seen; // how far what is seen there stands before the end of the ray
    if (before > 0.004) {
      blocked += clamp(1.6 - before / REACH, 0.0, 1.0);
    }
  }
  return 1 - blocked / SKY_RAYS;
}

float light_at(vec3 p, float spread, float tolerance) {
  vec3 q = light_from_view * (p + eye);
  float first = turn();
  float reached = 0;
  for (int i = 0; i < LIGHT_RAYS; ++i) {
    float angle = first + GOLDEN * float(i);
    float r = spread * sqrt((float(i) + 0.5) / LIGHT_RAYS);
    vec2 at = q.xy + r * vec2(cos(angle), sin(angle));
    reached += texture(shadow_map, at * 0.5 + 0.5).r > q.z + tolerance ? 0.0 : 1.0;
  }
  return reached / LIGHT_RAYS;
}

void main() {
  float depth = texture(distance, uv).r;
  if (depth < 1e8) {
    vec3 p = view_position(uv, depth);
    vec3 n = texture(surface, uv).xyz;
    shade = vec2(open_sky(p, n), light_at(p + 0.012 * n, 0.022, 0.02));
    return;
  }
  shade = vec2(1);
  vec3 ray = view_position(uv, 1);
  float along = (ground - dot(up, eye)) / dot(up, ray);
  if (dot(up, ray) < 0 && along > 0) {
    shade.y = light_at(ray * along, 0.11, 0.01);
  }
}
)";

/// Averages the shades along one axis over pixels of about the same depth.
inline constexpr const char* blur_fragment = R"(
in vec2 uv;
uniform sampler2D shades;
uniform sampler2D distance;
uniform vec2 step_size;
out vec2 shade;
void main() {
  float depth = texture(distance, uv).r;
  vec2 sum = vec2(0);
  float weights = 0;
  for (int i = -4; i <= 4; ++i) {
    vec2 at = uv + float(i) * step_size;
    float w = exp(-0.09 * float(i * i)) * max(0.0, 1 - abs(texture(distance, at).r - depth) * 25);
    sum += w * texture(shades, at).rg;
    weights += w;
  }
  shade = sum / weights;
}
)";

/// Light on the solids, over the background.
inline constexpr const char* light_fragment = R"(
in vec2 uv;
uniform sampler2D albedo;
uniform sampler2D surface;
uniform sampler2D distance;
uniform sampler2D shades;
uniform vec2 slope;
uniform vec3 up;            // of the model, in view space
uniform vec3 key;           // towards the main light
uniform vec4 background[2]; // at the bottom and at the top
uniform vec2 strength;      // of the shades
out vec4 color;

vec3 to_linear(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

// The shades have a pixel where the picture has several samples: takes them from those of the four
// nearest pixels that are about as far away, so that none leaks over an outline.
vec2 shade_at(float depth) {
  vec2 size = vec2(textureSize(shades, 0));
  vec2 corner = floor(uv * size - 0.5);
  vec2 part = uv * size - 0.5 - corner;
  vec2 sum = vec2(0);
  float weights = 0;
  for (int i = 0; i < 4; ++i) {
    vec2 offset = vec2(i & 1, i >> 1);
    vec2 at = (corner + offset + 0.5) / size;
    vec2 w = mix(1 - part, part, offset);
    float weight = (w.x * w.y + 1e-3) / (1e-3 + abs(texture(distance, at).r - depth));
    sum += weight * texture(shades, at).rg;
    weights += weight;
  }
  return sum / weights;
}

vec3 lit(vec3 base, vec3 n, vec3 to_eye, float open, float reached) {
  const vec3 fill = normalize(vec3(0.85, 0.10, 0.50));
  const vec3 rim = normalize(vec3(0.35, 0.55, -0.80));
  float half_open = mix(1.0, open, 0.5);
  vec3 light = open * 0.50 * mix(vec3(0.36, 0.31, 0.28), vec3(0.66, 0.74, 0.86), 0.5 + 0.5 * dot(n, up));
  light += reached * half_open * vec3(1.08, 1.00, 0.90) * max(0.0, (dot(n, key) + 0.10) / 1.10);
  light += half_open * vec3(0.12, 0.15, 0.20) * max(0.0, (dot(n, fill) + 0.25) / 1.25);
  light += open * vec3(0.30, 0.32, 0.34) * pow(max(0.0, dot(n, rim)), 1.5);
  float gloss = pow(max(0.0, dot(n, normalize(key + to_eye))), 28.0);
  float edge = pow(1 - max(0.0, dot(n, to_eye)), 4.0) * max(0.0, 0.5 + 0.5 * dot(n, up));
  return base * light + half_open * (0.06 * reached * gloss + 0.05 * edge);
}

void main() {
  float depth = texture(distance, uv).r;
  vec2 shade = shade_at(depth);
  vec4 base = texture(albedo, uv);
  if (base.a == 0) {
    vec4 behind = mix(background[0], background[1], smoothstep(0.0, 1.0, uv.y));
    float dark = 0.30 * (1 - shade.y) * strength.y;
    color = vec4(behind.rgb * (1 - dark), mix(behind.a, 1.0, dark));
    return;
  }
  vec3 p = vec3((uv * 2 - 1) * slope, -1) * depth;
  color = vec4(lit(to_linear(base.rgb), texture(surface, uv).xyz, normalize(-p),
                   pow(shade.x, strength.x), mix(1.0, shade.y, 0.8 * strength.y)), 1);
}
)";

/// The mean of the samples of each pixel, as sRGB with plain opacity.
inline constexpr const char* resolve_fragment = R"(
uniform sampler2D samples;
uniform int count;
out vec4 color;
void main() {
  vec4 sum = vec4(0);
  ivec2 corner = ivec2(gl_FragCoord.xy) * count;
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < count; ++x) {
      sum += clamp(texelFetch(samples, corner + ivec2(x, y), 0), 0.0, 1.0);
    }
  }
  sum /= float(count * count);
  vec3 c = sum.a > 0 ? sum.rgb / sum.a : vec3(0);
  c = mix(c * 12.92, 1.055 * pow(c, vec3(1 / 2.4)) - 0.055, step(0.0031308, c));
  color = vec4(c, sum.a);
}
)";

// ---- the cage

inline constexpr const char* face_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
out vec3 view_position;
out vec3 srgb;
void main() {
  view_position = to_view(position);
  srgb = color.rgb;
  gl_Position = to_clip(view_position);
}
)";

/// Tinted glass: clearer where one looks straight through, denser at grazing angles.
inline constexpr const char* face_fragment = R"(
in vec3 view_position;
in vec3 srgb;
uniform sampler2D model_distance;
uniform float opacity;
out vec4 color;
void main() {
  if (texelFetch(model_distance, ivec2(gl_FragCoord.xy), 0).r < -view_position.z) {
    discard;
  }
  vec3 n = normalize(cross(dFdx(view_position), dFdy(view_position)));
  float facing = abs(dot(n, normalize(view_position)));
  float alpha = clamp(opacity * mix(1.9, 0.85, facing), 0.0, 1.0);
  alpha *= gl_FrontFacing ? 1.0 : 0.6;
  vec3 base = pow(srgb, vec3(2.2));
  float key = max(0.0, dot(n, normalize(vec3(-0.55, 0.75, 0.62))));
  vec3 light = base * (0.75 + 0.55 * key) + 0.10 * key;
  color = vec4(light, 1) * alpha;
}
)";

/// Only how far the nearest face of the cage is.
inline constexpr const char* distance_fragment = R"(
in vec3 view_position;
out float distance;
void main() { distance = -view_position.z; }
)";

/// Whether something stands before a point of a line: looked up at the line's middle and on both
/// sides of it, since the faces that meet in the line are as near as the line itself.
inline constexpr const char* hidden_function = R"(
uniform sampler2D model_distance;
uniform sampler2D cage_distance;
uniform float samples;
bool is_behind(sampler2D depths, vec2 at, vec2 across, float depth) {
  vec2 size = vec2(textureSize(depths, 0));
  bool behind = true;
  for (int i = -1; i <= 1; ++i) {
    float seen = texture(depths, (at + float(i) * 1.5 * samples * across) / size).r;
    behind = behind && seen < depth - 0.004;
  }
  return behind;
}
)";

inline constexpr const char* line_vertex = R"(
layout(location = 0) in vec3 begin;
layout(location = 1) in vec3 end;
layout(location = 2) in vec4 color;
uniform vec2 frame;      // samples across and up
uniform float radius;    // half the width, samples
flat out vec2 first;     // the ends, in samples
flat out vec2 last;
flat out vec2 nearness;  // one over the distance at the ends: linear on the screen
flat out vec4 srgb;
void main() {
  vec3 a = to_view(begin), b = to_view(end);
  vec4 p = to_clip(a), q = to_clip(b);
  first = (p.xy / p.w * 0.5 + 0.5) * frame;
  last = (q.xy / q.w * 0.5 + 0.5) * frame;
  nearness = vec2(-1 / a.z, -1 / b.z);
  srgb = color;
  vec2 along = last - first;
  along = length(along) > 1e-4 ? normalize(along) : vec2(1, 0);
  vec2 across = vec2(-along.y, along.x);
  float reach = radius + 1;
  vec2 corner = (gl_VertexID & 1) == 0 ? first - reach * along : last + reach * along;
  corner += (gl_VertexID & 2) == 0 ? -reach * across : reach * across;
  gl_Position = vec4(corner / frame * 2 - 1, 0, 1);
}
)";

inline constexpr const char* line_fragment = R"(
flat in vec2 first;
flat in vec2 last;
flat in vec2 nearness;
flat in vec4 srgb;
uniform float radius;
uniform vec3 strength; // in front, behind the cage only, behind the model
out vec4 color;
void main() {
  vec2 along = last - first;
  float size = length(along);
  along = size > 1e-4 ? along / size : vec2(1, 0);
  float t = clamp(dot(gl_FragCoord.xy - first, along), 0.0, size);
  vec2 middle = first + t * along;
  float coverage = clamp(radius + 0.5 - distance(gl_FragCoord.xy, middle), 0.0, 1.0);
  if (coverage == 0) {
    discard;
  }
  float depth = 1 / mix(nearness.x, nearness.y, size > 1e-4 ? t / size : 0.0);
  vec2 across = vec2(-along.y, along.x);
  float alpha = srgb.a * coverage * strength.x;
  if (is_behind(model_distance, middle, across, depth)) {
    float dash = abs(fract(t / (9 * samples)) - 0.5) < 0.28 ? 1.0 : 0.0;
    alpha = srgb.a * coverage * strength.z * dash;
  } else if (is_behind(cage_distance, middle, across, depth)) {
    alpha = srgb.a * coverage * strength.y;
  }
  color = vec4(pow(srgb.rgb, vec3(2.2)), 1) * alpha;
}
)";

inline constexpr const char* dot_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
uniform vec2 frame;
uniform float radius;
flat out vec2 middle;
flat out float depth;
flat out vec4 srgb;
void main() {
  vec3 v = to_view(position);
  vec4 p = to_clip(v);
  middle = (p.xy / p.w * 0.5 + 0.5) * frame;
  depth = -v.z;
  srgb = color;
  vec2 corner = middle + (radius + 1) * (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2 - 1);
  gl_Position = vec4(corner / frame * 2 - 1, 0, 1);
}
)";

inline constexpr const char* dot_fragment = R"(
flat in vec2 middle;
flat in float depth;
flat in vec4 srgb;
uniform float radius;
uniform vec3 strength;
out vec4 color;
void main() {
  float coverage = clamp(radius + 0.5 - distance(gl_FragCoord.xy, middle), 0.0, 1.0);
  if (coverage == 0) {
    discard;
  }
  float alpha = strength.x;
  bool behind_model = is_behind(model_distance, middle, vec2(1, 0), depth) &&
                      is_behind(model_distance, middle, vec2(0, 1), depth);
  bool behind_cage = is_behind(cage_distance, middle, vec2(1, 0), depth) &&
                     is_behind(cage_distance, middle, vec2(0, 1), depth);
  alpha = behind_model ? strength.z : behind_cage ? strength.y : strength.x;
  color = vec4(pow(srgb.rgb, vec3(2.2)), 1) * (srgb.a * coverage * alpha);
}
)";

} // namespace cagewright::shaders
