/// \file
/// The viewport's programs for the graphics card, in GLSL. Private to canvas.cpp.
#pragma once

namespace cagewright::app::shaders {

inline constexpr const char* background_vertex = R"(
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2;
  gl_Position = vec4(uv * 2 - 1, 0.999999, 1);
}
)";

inline constexpr const char* background_fragment = R"(
in vec2 uv;
uniform vec3 top;
uniform vec3 bottom;
out vec4 color;
void main() {
  // A little noise, so that the gradient shows no steps.
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  color = vec4(mix(bottom, top, smoothstep(0.0, 1.0, uv.y)) + (noise - 0.5) / 255, 1);
}
)";

inline constexpr const char* light = R"(
uniform mat3 axes;
// A main light from the upper left, a fill from the right, the sky; n towards the viewer.
vec3 lit(vec3 base, vec3 n) {
  float key = max(0.0, dot(n, normalize(vec3(-0.45, 0.65, 0.62))));
  float fill = max(0.0, dot(n, normalize(vec3(0.8, 0.05, 0.45))));
  vec3 sky = mix(vec3(0.38, 0.35, 0.33), vec3(0.52, 0.53, 0.55), 0.5 + 0.5 * n.y);
  vec3 light = sky + 0.58 * key * vec3(1.0, 0.97, 0.92) + 0.14 * fill * vec3(0.85, 0.9, 1.0);
  float gloss = pow(max(0.0, dot(n, normalize(vec3(-0.25, 0.38, 0.9)))), 40.0);
  return base * light + 0.07 * gloss;
}
)";

/// The looks of SurfaceLook. n towards the viewer; right, up, backward.
inline constexpr const char* surfaces = R"(
vec3 clay(vec3 n) {
  float t = dot(n, normalize(vec3(-0.4, 0.62, 0.67)));
  vec3 c = mix(vec3(0.20, 0.105, 0.085), vec3(0.60, 0.335, 0.25), smoothstep(-0.55, 0.35, t));
  c = mix(c, vec3(0.90, 0.66, 0.53), smoothstep(0.2, 1.0, t));
  float rim = pow(1.0 - max(n.z, 0.0), 3.0);
  return c + 0.10 * rim * vec3(0.8, 0.85, 1.0);
}
vec3 wax(vec3 n) {
  float t = dot(n, normalize(vec3(-0.45, 0.6, 0.66)));
  vec3 c = mix(vec3(0.52, 0.33, 0.22), vec3(0.97, 0.90, 0.78), smoothstep(-0.8, 0.9, t));
  c += 0.16 * pow(1.0 - max(n.z, 0.0), 2.0) * vec3(1.0, 0.62, 0.35); // what shines through
  return c + 0.22 * pow(max(0.0, dot(n, normalize(vec3(-0.22, 0.36, 0.91)))), 60.0);
}
vec3 metal(vec3 n) {
  vec3 r = vec3(2.0 * n.z * n.xy, 2.0 * n.z * n.z - 1.0); // where the view is mirrored to
  float height = r.y + 0.18 * r.x;
  vec3 sky = mix(vec3(0.60, 0.64, 0.70), vec3(0.97, 0.98, 1.0), smoothstep(0.05, 0.75, height));
  vec3 ground = mix(vec3(0.13, 0.12, 0.12), vec3(0.42, 0.40, 0.38), smoothstep(-0.9, -0.05, height));
  vec3 c = mix(ground, sky, smoothstep(-0.06, 0.06, height));
  return c * mix(0.72, 1.0, n.z);
}
vec3 stripes(vec3 n) {
  vec3 r = vec3(2.0 * n.z * n.xy, 2.0 * n.z * n.z - 1.0);
  float t = 9.0 * acos(clamp(r.y, -1.0, 1.0)) / 3.14159265;
  float soft = clamp(1.5 * fwidth(t), 0.02, 0.5);
  float wave = abs(fract(t) - 0.5) * 2.0;
  float ink = smoothstep(0.5 - soft, 0.5 + soft, wave);
  return mix(vec3(0.10, 0.11, 0.13), vec3(0.94), ink) * (0.55 + 0.45 * n.z);
}
vec3 surface(int look, vec3 base, vec3 n) {
  return look == 1 ? clay(n) : look == 2 ? wax(n) : look == 3 ? metal(n) : look == 4 ? stripes(n) : lit(base, n);
}
)";

/// The mean of pictures: see FinePicture. Shade comes from what is before the tangent plane of a
/// pixel's surface, near it, as Alchemy's ambient obscurance does (McGuire et al. 2011).
inline constexpr const char* fine_vertex = R"(
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2;
  gl_Position = vec4(uv * 2 - 1, 0, 1);
}
)";

inline constexpr const char* fine_fragment = R"(
in vec2 uv;
uniform sampler2D picture;
uniform sampler2D depths;
uniform float share;
uniform mat4 clip;
uniform mat4 unclip;
uniform mat3 axes;
uniform float strength;
uniform float radius;
uniform int number;
uniform vec2 frame;
out vec4 color;
vec3 place(vec2 at, float depth) {
  vec4 p = unclip * vec4(at * 2 - 1, depth * 2 - 1, 1);
  return p.xyz / p.w;
}
vec3 place_at(vec2 at) { return place(at, textureLod(depths, at, 0).r); }
// Of two neighbors the one that lies on the same surface.
vec3 step_to(vec3 p, vec2 at, vec2 by) {
  vec3 a = place_at(at + by) - p;
  vec3 b = p - place_at(at - by);
  return dot(a, a) < dot(b, b) ? a : b;
}
void main() {
  vec3 seen = textureLod(picture, uv, 0).rgb;
  color = vec4(seen, share);
  float depth = textureLod(depths, uv, 0).r;
  if (strength <= 0 || depth >= 0.999999) {
    return;
  }
  vec3 p = place(uv, depth);
  vec2 pixel = 1 / frame;
  vec3 n = normalize(cross(step_to(p, uv, vec2(pixel.x, 0)), step_to(p, uv, vec2(0, pixel.y))));
  if (dot(n, place(uv, 0) - p) < 0) {
    n = -n;
  }
  // As wide as the radius is there.
  vec4 beside = clip * vec4(p + radius * axes[0], 1);
  vec4 here = clip * vec4(p, 1);
  float reach = length((beside.xy / beside.w - here.xy / here.w) * frame / 2);
  reach = clamp(reach, 3.0, 0.25 * frame.y);
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy + 5.588238 * float(number),
                                             vec2(0.06711056, 0.00583715))));
  const int count = 6;
  float shade = 0;
  for (int i = 0; i < count; ++i) {
    float far = (float(i) + noise) / float(count);
    float angle = 6.2831853 * (noise + 0.618034 * float(i) + 0.3819 * float(number));
    vec3 q = place_at(uv + pixel * reach * far * vec2(cos(angle), sin(angle)));
    vec3 v = q - p;
    float d2 = dot(v, v);
    float near = max(0.0, 1.0 - d2 / (radius * radius));
    shade += near * max(0.0, dot(n, v) * inversesqrt(d2 + 1e-9) - 0.08);
  }
  color.rgb = seen * (1.0 - min(0.85, strength * shade / float(count)));
}
)";

inline constexpr const char* model_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 color;
layout(location = 3) in vec2 texture_point;
layout(location = 4) in vec4 texture_place;
uniform mat4 clip;
uniform mat3 axes;
uniform vec4 one_color; // opacity 0: each vertex has its own
out vec3 view_normal;
out vec3 place;
out vec3 base;
out vec2 texture_at;
flat out vec4 texture_in;
void main() {
  view_normal = axes * normal.xyz;
  place = axes * position;
  base = one_color.a > 0 ? one_color.rgb : color.rgb;
  texture_at = texture_point;
  texture_in = texture_place;
  gl_Position = clip * vec4(position, 1);
}
)";

inline constexpr const char* model_fragment = R"(
in vec3 view_normal;
in vec3 place;
in vec3 base;
uniform int smooth_normals;
uniform int look;
in vec2 texture_at;
flat in vec4 texture_in; // corner and size in the atlas
uniform int textured;
uniform vec2 texture_size;
uniform sampler2D atlas;
// Not of the neighbors in the atlas: half a pixel within.
vec3 texture_color() {
  if (textured == 0 || texture_in.z <= 0) {
    return vec3(1);
  }
  vec2 half_pixel = 0.5 / (texture_in.zw * texture_size);
  vec2 at = clamp(fract(texture_at), half_pixel, 1 - half_pixel);
  return textureLod(atlas, texture_in.xy + at * texture_in.zw, 0).rgb;
}
out vec4 color;
void main() {
  vec3 flat_normal = normalize(cross(dFdx(place), dFdy(place)));
  vec3 n = smooth_normals != 0 && dot(view_normal, view_normal) > 0.25 ? normalize(view_normal)
                                                                        : flat_normal;
  if (dot(n, flat_normal) < 0) { // the back of the surface
    n = -n;
  }
  color = vec4(surface(look, base * texture_color(), n), 1);
}
)";

inline constexpr const char* wire_vertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 clip;
void main() {
  gl_Position = clip * vec4(position, 1);
  gl_Position.z -= 2e-5 * gl_Position.w;
}
)";

inline constexpr const char* wire_fragment = R"(
uniform vec4 one_color;
out vec4 color;
void main() { color = one_color; }
)";

inline constexpr const char* face_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
uniform mat4 clip;
uniform mat3 axes;
out vec3 place;
out vec4 srgb;
void main() {
  place = axes * position;
  srgb = color;
  gl_Position = clip * vec4(position, 1);
}
)";

/// kind 0: lit and opaque; 1: like tinted glass; 2: as it is.
inline constexpr const char* face_fragment = R"(
in vec3 place;
in vec4 srgb;
uniform int kind;
out vec4 color;
void main() {
  if (kind == 2) {
    color = vec4(srgb.rgb * srgb.a, srgb.a);
    return;
  }
  vec3 n = normalize(cross(dFdx(place), dFdy(place)));
  if (kind == 0) {
    color = vec4(lit(srgb.rgb, n), 1);
    return;
  }
  float alpha = srgb.a * (gl_FrontFacing ? 1.0 : 0.5);
  color = vec4(mix(srgb.rgb, lit(srgb.rgb, n) * 1.1, 0.5) * alpha, alpha);
}
)";

/// A line as a strip of four corners, a pixel wider than it, for its smooth rim.
inline constexpr const char* line_vertex = R"(
layout(location = 0) in vec3 begin;
layout(location = 1) in vec3 end;
layout(location = 2) in vec4 color;
layout(location = 3) in float width;
uniform mat4 clip;
uniform vec2 frame; // device pixels
uniform float pixel_ratio;
uniform float bias;
noperspective out float across;
flat out float radius;
flat out vec4 srgb;
void main() {
  vec4 p = clip * vec4(begin, 1);
  vec4 q = clip * vec4(end, 1);
  float before_p = p.z + p.w; // of the near plane
  float before_q = q.z + q.w;
  if (before_p < 0 && before_q < 0) {
    gl_Position = vec4(2, 2, 2, 1);
    return;
  }
  if (before_p < 0) {
    p = mix(p, q, before_p / (before_p - before_q));
  } else if (before_q < 0) {
    q = mix(q, p, before_q / (before_q - before_p));
  }
  vec2 a = p.xy / p.w * frame / 2;
  vec2 b = q.xy / q.w * frame / 2;
  vec2 along = length(b - a) > 1e-4 ? normalize(b - a) : vec2(1, 0);
  radius = 0.5 * width * pixel_ratio;
  across = (gl_VertexID & 2) == 0 ? -(radius + 1) : radius + 1;
  bool first = (gl_VertexID & 1) == 0;
  vec2 shift = across * vec2(-along.y, along.x) + (first ? -0.5 : 0.5) * along;
  gl_Position = first ? p : q;
  gl_Position.xy += shift * 2 / frame * gl_Position.w;
  gl_Position.z -= bias * gl_Position.w;
  srgb = color;
}
)";

inline constexpr const char* line_fragment = R"(
noperspective in float across;
flat in float radius;
flat in vec4 srgb;
uniform float strength;
out vec4 color;
void main() {
  float alpha = srgb.a * strength * clamp(radius + 0.5 - abs(across), 0.0, 1.0);
  if (alpha < 0.004) {
    discard;
  }
  color = vec4(srgb.rgb * alpha, alpha);
}
)";

inline constexpr const char* dot_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 2) in float size;
uniform mat4 clip;
uniform vec2 frame;
uniform float pixel_ratio;
uniform float bias;
noperspective out vec2 offset;
flat out float radius;
flat out vec4 srgb;
void main() {
  vec4 p = clip * vec4(position, 1);
  radius = size * pixel_ratio;
  offset = (radius + 1.5) * (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2 - 1);
  gl_Position = p.z + p.w < 0 ? vec4(2, 2, 2, 1) : p;
  gl_Position.xy += offset * 2 / frame * gl_Position.w;
  gl_Position.z -= bias * gl_Position.w;
  srgb = color;
}
)";

inline constexpr const char* dot_fragment = R"(
noperspective in vec2 offset;
flat in float radius;
flat in vec4 srgb;
uniform float strength;
out vec4 color;
void main() {
  float distance = length(offset);
  float alpha = srgb.a * strength * clamp(radius + 0.5 - distance, 0.0, 1.0);
  if (alpha < 0.004) {
    discard;
  }
  float rim = clamp(distance - radius + 1.7, 0.0, 1.0); // a darker outline
  color = vec4(srgb.rgb * mix(1.0, 0.55, rim) * alpha, alpha);
}
)";

} // namespace cagewright::app::shaders
