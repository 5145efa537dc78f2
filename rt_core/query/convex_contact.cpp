// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/convex_contact.hpp"

#include <optional>

#ifdef TACTUS_HAS_CCD
#include "rt_core/math/direction.hpp"
#include "rt_core/math/safe_scale.hpp"

#include <ccd/ccd.h>

#include <algorithm>
#endif

namespace tactus
{

namespace
{

#ifdef TACTUS_HAS_CCD

static_assert(sizeof(ccd_real_t) == sizeof(double), "libccd is built for single precision");

/// Body in the form for libccd: relative to its centre, and multiplied by `scale`.
struct ScaledBody
{
    const ConvexBody& body;
    double scale;
};

void put(ccd_vec3_t* out, const Vec3& v) noexcept
{
    *out = {{v.x(), v.y(), v.z()}};
}

Vec3 from(const ccd_vec3_t* v) noexcept
{
    return {v->v[0], v->v[1], v->v[2]};
}

/// Support function of the body for libccd, whose directions may have any length, also zero between
/// flat shapes.
void support_body(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) noexcept
{
    const auto& [body, scale] = *static_cast<const ScaledBody*>(object);
    const Vec3 way = from(direction);
    const Vec3 unit = has_direction(way) ? unit_of(way) : Vec3(1.0, 0.0, 0.0);
    put(out, body.support(body.context, unit) * scale);
}

void support_triangle(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) noexcept
{
    const auto& triangle = *static_cast<const Triangle*>(object);
    const Vec3 way = from(direction);
    const auto* farthest = std::ranges::max_element(triangle, [&way](const Vec3& a, const Vec3& b)
                                                    { return way.dot(a) < way.dot(b); });
    put(out, *farthest);
}

/// First direction for libccd: to a corner of the triangle. Any start works.
void begin_at_the_triangle(const void* /*body*/, const void* triangle, ccd_vec3_t* out) noexcept
{
    put(out, (*static_cast<const Triangle*>(triangle))[0]);
}

// libccd is not annotated, but this call needs only its stack, and max_iterations bounds it.
TACTUS_TRUSTED_BEGIN
std::optional<bool> ask_ccd(const ConvexBody& body,
                            const Triangle& triangle) noexcept TACTUS_NONBLOCKING
{
    Triangle near{triangle[0] - body.center, triangle[1] - body.center, triangle[2] - body.center};
    const double scale = scale_to_one(std::max(largest_coordinate(near), body.radius));
    near = scaled(near, scale);
    const ScaledBody scaled_body{body, scale};
    ccd_t settings{};
    settings.first_dir = begin_at_the_triangle;
    settings.support1 = support_body;
    settings.support2 = support_triangle;
    settings.max_iterations = kGjkIterations;
    return ccdGJKIntersect(&scaled_body, &near, &settings) != 0;
}
TACTUS_TRUSTED_END

#else

std::optional<bool> ask_ccd(const ConvexBody& /*body*/, const Triangle& /*triangle*/) noexcept
{
    return std::nullopt;
}

#endif

} // namespace

ConvexContact contact_of(const ConvexBody& body, const Triangle& triangle, Vec3& direction,
                         double limit) noexcept
{
    ConvexContact contact;
    contact.nearest = gjk_distance(body, triangle, direction, limit);
    const GjkAnswer& nearest = contact.nearest;
    if (nearest.lower > limit)
    {
        return contact;
    }
    const bool is_apart = nearest.lower > 0.0;
    const bool is_touching = nearest.upper <= 2.0 * nearest.rounding;
    const std::optional<bool> answer = ask_ccd(body, triangle);
    contact.meet = !is_apart && (is_touching || answer.value_or(true));
    contact.is_ccd_overruled = (is_apart || is_touching) && answer && *answer != contact.meet;
    return contact;
}

} // namespace tactus
