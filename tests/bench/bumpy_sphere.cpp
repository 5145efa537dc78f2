// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bumpy_sphere.hpp"

#include "host_tools/shapes/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr double kRadius_m = 0.05;
constexpr double kBump = 0.02;
constexpr double kWaves = 8.0;

/// Limit of projections. Each leaves curvature x distance of the error, about 0.3 at worst.
constexpr int kMaxProjections = 60;
constexpr double kProjected_m = 1e-17;

constexpr std::uint32_t kLeadIn = 200;
constexpr double kLeadInHeight_m = 1e-3;

double angle_between(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

Vec3 normal_of(const test::Face& face)
{
    const Vec3 first = to_vec3(face[0]);
    return (to_vec3(face[1]) - first).cross(to_vec3(face[2]) - first);
}

/// Numbers of the positions of corners; equal positions have equal numbers.
std::vector<std::uint32_t> corner_numbers(const std::vector<test::Face>& faces)
{
    const auto place = [&](std::uint32_t corner) -> const Vec3f&
    { return faces[corner / 3][corner % 3]; };
    std::vector<std::uint32_t> order(3 * faces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, {}, place);
    std::vector<std::uint32_t> numbers(order.size());
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        number += i > 0 && place(order[i]) != place(order[i - 1]) ? 1U : 0U;
        numbers[order[i]] = number;
    }
    return numbers;
}

Vec3 direction_at(double angle)
{
    static const Vec3 kFirst = Vec3(0.8, 0.0, -0.36).normalized();
    static const Vec3 kSecond = Vec3(0.36, 0.48, 0.8).normalized().cross(kFirst).normalized();
    return std::cos(angle) * kFirst + std::sin(angle) * kSecond;
}

Vec3 surface_point(const Vec3& direction)
{
    return bumpy_radius_m(direction.x(), direction.y(), direction.z()) * direction;
}

Vec3 above(const Vec3& surface_m, double height_m)
{
    return surface_m + height_m * bumpy_gradient(surface_m).normalized();
}

} // namespace

double bumpy_value_m(const Vec3& x)
{
    const Vec3 u = x.normalized();
    return x.norm() - bumpy_radius_m(u.x(), u.y(), u.z());
}

Vec3 bumpy_gradient(const Vec3& x)
{
    const Vec3 u = x.normalized();
    const Vec3 sine(std::sin(kWaves * u.x()), std::sin(kWaves * u.y()), std::sin(kWaves * u.z()));
    const Vec3 cosine(std::cos(kWaves * u.x()), std::cos(kWaves * u.y()), std::cos(kWaves * u.z()));
    const Vec3 slope =
        kWaves * Vec3(cosine.x() * sine.y() * sine.z(), sine.x() * cosine.y() * sine.z(),
                      sine.x() * sine.y() * cosine.z());
    return u - kRadius_m * kBump / x.norm() * (slope - u * u.dot(slope));
}

SurfaceFoot bumpy_foot(const Vec3& x)
{
    Vec3 foot = x;
    for (int i = 0; i < kMaxProjections; ++i)
    {
        const Vec3 gradient = bumpy_gradient(foot);
        const double excess = bumpy_value_m(foot) + gradient.dot(x - foot);
        const Vec3 next = x - excess / gradient.squaredNorm() * gradient;
        const double moved_m = (next - foot).norm();
        foot = next;
        if (moved_m <= kProjected_m)
        {
            break;
        }
    }
    const Vec3 normal = bumpy_gradient(foot).normalized();
    return {foot, normal, (x - foot).dot(normal)};
}

double bumpy_curvature_per_m(const Vec3& x)
{
    constexpr double kStep_m = 1e-7;
    const SurfaceFoot foot = bumpy_foot(x);
    const Vec3 first = foot.normal.unitOrthogonal();
    const Vec3 second = foot.normal.cross(first);
    const auto turn = [&](const Vec3& along) -> Vec3
    {
        const Vec3 step = kStep_m * along;
        return (bumpy_gradient(foot.point_m + step).normalized() -
                bumpy_gradient(foot.point_m - step).normalized()) /
               (2.0 * kStep_m);
    };
    const Vec3 turn_first = turn(first);
    const Vec3 turn_second = turn(second);
    const double mean = 0.5 * (turn_first.dot(first) + turn_second.dot(second));
    const double apart = 0.5 * (turn_first.dot(first) - turn_second.dot(second));
    const double twist = 0.5 * (turn_first.dot(second) + turn_second.dot(first));
    return std::abs(mean) + std::hypot(apart, twist);
}

Vec3 bumpy_force_n(const Vec3& device_m, double radius_m, double stiffness_n_per_m)
{
    const SurfaceFoot foot = bumpy_foot(device_m);
    return stiffness_n_per_m * std::max(0.0, radius_m - foot.distance_m) * foot.normal;
}

double Faceting::force_error_n(const Touch& touch) const
{
    return touch.stiffness_n_per_m * (distance_m + touch.depth_m * force_rotation_rad(touch));
}

double Faceting::force_rotation_rad(const Touch& touch) const
{
    return normal_rad / (1.0 - curvature_per_m * (touch.radius_m + touch.depth_m));
}

Faceting measure_faceting(const std::vector<test::Face>& faces,
                          const std::array<double, 3>& origin_m)
{
    const Vec3 origin(origin_m[0], origin_m[1], origin_m[2]);
    Faceting worst;
    for (const test::Face& face : faces)
    {
        const Vec3 a = origin + to_vec3(face[0]);
        const Vec3 b = origin + to_vec3(face[1]);
        const Vec3 c = origin + to_vec3(face[2]);
        const Vec3 normal = normal_of(face);
        for (const Vec3& point : {a, b, c, Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)),
                                  Vec3(0.5 * (c + a)), Vec3((a + b + c) / 3.0)})
        {
            const SurfaceFoot foot = bumpy_foot(point);
            worst.distance_m = std::max(worst.distance_m, std::abs(foot.distance_m));
            worst.normal_rad = std::max(worst.normal_rad, angle_between(normal, foot.normal));
        }
        worst.curvature_per_m = std::max(worst.curvature_per_m, bumpy_curvature_per_m(a));
    }
    worst.dihedral_rad = largest_dihedral_rad(faces);
    return worst;
}

double largest_dihedral_rad(const std::vector<test::Face>& faces)
{
    const std::vector<std::uint32_t> numbers = corner_numbers(faces);
    // Sides of faces: the ends, and the face.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sides;
    sides.reserve(numbers.size());
    for (std::uint32_t face = 0; face < faces.size(); ++face)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto [low, high] =
                std::minmax(numbers[3 * face + i], numbers[3 * face + (i + 1) % 3]);
            sides.emplace_back((std::uint64_t{low} << 32U) | high, face);
        }
    }
    std::ranges::sort(sides);
    double largest_rad = 0.0;
    for (std::size_t i = 1; i < sides.size(); ++i)
    {
        if (sides[i].first == sides[i - 1].first)
        {
            largest_rad = std::max(largest_rad, angle_between(normal_of(faces[sides[i - 1].second]),
                                                              normal_of(faces[sides[i].second])));
        }
    }
    return largest_rad;
}

Sweep make_sweep(const Touch& touch, double step_m, std::uint32_t frames)
{
    return make_sweep(touch, std::vector<double>(frames, step_m));
}

Sweep make_sweep(const Touch& touch, std::span<const double> steps_m)
{
    Sweep sweep;
    sweep.lead_in = kLeadIn;
    const double held_m = touch.radius_m - touch.depth_m;
    double angle = 0.0;
    const Vec3 start = surface_point(direction_at(angle));
    const double fall_m = (touch.depth_m + kLeadInHeight_m) / (kLeadIn - 1);
    for (std::uint32_t i = 0; i < kLeadIn; ++i)
    {
        sweep.goals_m.push_back(above(start, held_m + fall_m * (kLeadIn - 1 - i)));
        sweep.rests_m.push_back(above(start, touch.radius_m));
    }
    Vec3 last = above(start, held_m);
    for (const double step_m : steps_m)
    {
        double turn = step_m / kRadius_m;
        for (int round = 0; round < 8; ++round) // Each round leaves some per cent of the error.
        {
            const Vec3 next = above(surface_point(direction_at(angle + turn)), held_m);
            turn *= step_m / (next - last).norm();
        }
        angle += turn;
        const Vec3 surface = surface_point(direction_at(angle));
        last = above(surface, held_m);
        sweep.goals_m.push_back(last);
        sweep.rests_m.push_back(above(surface, touch.radius_m));
    }
    return sweep;
}

} // namespace tactus::bench
