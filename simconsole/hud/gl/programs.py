"""The programs of the graphics card (GLSL 3.30): lit surfaces, sky, shadow map, and pictures laid over the scene."""

from typing import Final

SURFACE_VERTEX: Final = """
#version 330
uniform mat4 view_projection;
uniform mat4 model;
uniform mat4 to_shadow;
in vec3 in_position;
in vec4 in_normal;
in vec4 in_colour;
out vec3 place;
out vec3 normal;
flat out vec3 colour;
flat out int material;
#ifdef SHADOWS
out vec3 shadow_place;
#endif
void main() {
    vec4 world = model * vec4(in_position, 1.0);
    place = world.xyz;
    normal = mat3(model) * ((in_normal.xyz * 255.0 - 128.0) / 127.0);
    colour = in_colour.rgb * in_colour.rgb;  // about linear light
    material = int(in_colour.a * 255.0 + 0.5);
#ifdef SHADOWS
    shadow_place = (to_shadow * world).xyz * 0.5 + 0.5;
#endif
    gl_Position = view_projection * world;
}
"""

SURFACE_FRAGMENT: Final = """
#version 330
uniform vec3 eye;
uniform vec3 sun;
uniform vec3 sun_light;
uniform vec3 sky_light;
uniform vec3 fog;
uniform float fog_per_m;
uniform float night;
uniform vec3 lamp_place;
uniform mat3 lamp_axes;  // of the vehicle: ahead, left, up
#ifdef SHADOWS
uniform sampler2DShadow shadow_map;
in vec3 shadow_place;
#endif
in vec3 place;
in vec3 normal;
flat in vec3 colour;
flat in int material;
out vec4 pixel;

float scatter(vec2 at) { return fract(sin(dot(at, vec2(12.9898, 78.233))) * 43758.5453); }

void main() {
    vec3 base = colour;
    float glow = 0.0;
    float away = distance(place, eye);
    if (material == 1 && abs(normal.z) < 0.5) {
        vec2 wall = vec2(dot(place.xy, vec2(-normal.y, normal.x)) / 2.6, place.z / 3.0);
        vec2 inside = abs(fract(wall) - vec2(0.5, 0.55));
        if (inside.x < 0.24 && inside.y < 0.26) {
            base = vec3(0.035, 0.05, 0.07);
            glow = night * step(0.62, scatter(floor(wall) + floor(place.xy * 0.02)));
        }
    } else if (material == 2) {
        glow = 1.0;
    }
#ifdef DETAIL
    if (material == 3 && away < 60.0)
        base *= mix(0.88 + 0.24 * scatter(floor(place.xy * 24.0)), 1.0, smoothstep(15.0, 60.0, away));
    if (material == 4 && away < 120.0)
        base *= mix(0.86 + 0.28 * scatter(floor(place.xy * 5.0)), 1.0, smoothstep(30.0, 120.0, away));
#endif
    float facing = max(dot(normal, sun), 0.0);
#ifdef SHADOWS
    vec3 at = shadow_place;
    if (facing > 0.0 && at.x > 0.0 && at.x < 1.0 && at.y > 0.0 && at.y < 1.0 && at.z < 1.0)
        facing *= texture(shadow_map, vec3(at.xy, at.z - 0.0012));
#endif
    vec3 light = sky_light * (0.72 + 0.28 * normal.z) + sun_light * facing;
    if (night > 0.0) {
        vec3 from = (place - lamp_place) * lamp_axes;
        float ahead = from.x;
        float reach = max(ahead, 0.5);
        float cone = smoothstep(0.55, 0.18, abs(from.y) / reach) * smoothstep(0.12, -0.02, from.z / reach);
        light += night * step(0.0, ahead) * cone * vec3(1.25, 1.18, 1.0) * 900.0 / (900.0 + ahead * ahead);
    }
    vec3 lit = material == 2 ? base : mix(base * light, vec3(1.0, 0.78, 0.42) * 0.5, glow);
    float clear = exp(-away * fog_per_m);
    pixel = vec4(sqrt(mix(fog, lit, clear)), 1.0);
}
"""

SKY_VERTEX: Final = """
#version 330
uniform mat4 from_clip;
in vec2 in_place;
out vec3 direction;
void main() {
    vec4 far = from_clip * vec4(in_place, 1.0, 1.0);
    direction = far.xyz / far.w;
    gl_Position = vec4(in_place, 0.9999999, 1.0);
}
"""

SKY_FRAGMENT: Final = """
#version 330
uniform vec3 sun;
uniform vec3 horizon;
uniform vec3 zenith;
uniform float night;
in vec3 direction;
out vec4 pixel;
void main() {
    vec3 towards = normalize(direction);
    vec3 colour = mix(horizon, zenith, clamp(towards.z * 1.6, 0.0, 1.0));
    float near_sun = max(dot(towards, sun), 0.0);
    colour += (1.0 - night) * (vec3(1.0, 0.9, 0.7) * 0.25 * pow(near_sun, 64.0) + step(0.9996, near_sun));
    pixel = vec4(sqrt(colour), 1.0);
}
"""

SHADOW_VERTEX: Final = """
#version 330
uniform mat4 to_shadow;
uniform mat4 model;
in vec3 in_position;
void main() { gl_Position = to_shadow * model * vec4(in_position, 1.0); }
"""

SHADOW_FRAGMENT: Final = """
#version 330
void main() {}
"""

OVERLAY_VERTEX: Final = """
#version 330
in vec2 in_place;
out vec2 at;
void main() {
    at = vec2(0.5 + 0.5 * in_place.x, 0.5 - 0.5 * in_place.y);
    gl_Position = vec4(in_place, 0.0, 1.0);
}
"""

OVERLAY_FRAGMENT: Final = """
#version 330
uniform sampler2D picture;
in vec2 at;
out vec4 pixel;
void main() { pixel = texelFetch(picture, ivec2(at * vec2(textureSize(picture, 0))), 0); }
"""


def variant(source: str, *, shadows: bool, detail: bool) -> str:
    """Return a program's source with what a picture is to have."""
    head, rest = source.strip().split("\n", 1)
    wanted = [f"#define {name}" for name, on in (("SHADOWS", shadows), ("DETAIL", detail)) if on]
    return "\n".join((head, *wanted, rest))
