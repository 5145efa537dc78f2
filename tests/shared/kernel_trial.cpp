// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/kernel_trial.hpp"

#include "rt_core/geometry/box_triangle.hpp"
#include "rt_core/geometry/closest_points.hpp"
#include "tests/shared/round_triangle.hpp"
#include "tests/shared/shape_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>

namespace tactus::test
{

namespace
{

/// Question to a kernel with its answer and the truth.
struct Case
{
    ClosestPoints answer;
    std::function<long double()> distance;
    std::function<Quad()> exact_distance; ///< Exact distance, 50 times slower.
    std::function<double(const Vec3&)> off_shape;
    Triangle triangle;
    double magnitude; ///< Largest coordinate, which determines the rounding of points.
    double local_length;
};

/// Result of one case.
struct Judgement
{
    double error{0.0};           ///< Error relative to the error law.
    const char* broken{nullptr}; ///< Other fault.
};

double largest_coordinate_of(std::span<const Vec3> points)
{
    double most = 0.0;
    for (const Vec3& point : points)
    {
        most = std::max(most, point.cwiseAbs().maxCoeff());
    }
    return most;
}

double longest_way(std::span<const Vec3> points)
{
    double most = 0.0;
    for (const Vec3& a : points)
    {
        for (const Vec3& b : points)
        {
            most = std::max(most, (a - b).norm());
        }
    }
    return most;
}

double off_place(const Vec3& point, const Triangle& triangle, TriangleFeature feature)
{
    const auto at = static_cast<std::size_t>(feature);
    if (at < 3)
    {
        return (point - triangle[at]).norm();
    }
    return static_cast<double>(
        at < 6 ? QuadDistanceOracle::to_segment(point, triangle[at - 3], triangle[(at - 2) % 3])
               : QuadDistanceOracle::distance(point, triangle));
}

/// Distance, in local lengths, that the wider numbers may leave between meeting shapes if a
/// triangle is thin.
constexpr double kTouching = 1e-17;

bool is_finite(const ClosestPoints& answer)
{
    return answer.on_shape.allFinite() && answer.on_triangle.allFinite() &&
           answer.gap.allFinite() && std::isfinite(answer.distance) &&
           std::isfinite(answer.distance_error);
}

double share(double value, double allowed)
{
    return value == 0.0 ? 0.0 : value / allowed;
}

Judgement judge(const Case& one)
{
    const ClosestPoints& answer = one.answer;
    const double law = 4e-16 * one.local_length;
    if (!is_finite(answer))
    {
        return {0.0, "not finite"};
    }
    if (answer.distance_error > 1.00025 * law)
    {
        return {0.0, "a distance_error above the law"};
    }
    double off =
        static_cast<double>(std::abs(one.distance() - static_cast<long double>(answer.distance)));
    if (off > 0.5 * law || answer.meet)
    {
        off = static_cast<double>(one.exact_distance() - static_cast<Quad>(answer.distance));
        off = std::abs(off);
    }
    const double error = share(off, law);
    if (off > (answer.meet ? kTouching * one.local_length : answer.distance_error))
    {
        return {error, "a distance off by more than its error"};
    }
    const double slack = law + 2.3e-16 * one.magnitude;
    if (std::max(off_place(answer.on_triangle, one.triangle, answer.feature),
                 one.off_shape(answer.on_shape)) > slack)
    {
        return {error, "a point that is not on its feature"};
    }
    // Both points are rounded.
    if (std::max(std::abs(answer.gap.norm() - answer.distance),
                 (answer.on_triangle - answer.on_shape - answer.gap).norm()) > 2.0 * slack)
    {
        return {error, "a gap that is not between the points"};
    }
    return {error, nullptr};
}

/// Runs cases; `ask` asks the kernel about a pair and judges the answer.
template <typename Ask>
TrialFigures run_cases(const char* kernel, const PairClass& kind, int cases, Random& random,
                       const Ask& ask)
{
    TrialFigures figures;
    figures.name = std::string(kernel) + ", " + kind.name;
    figures.unit = "of the law";
    for (int i = 0; i < cases; ++i)
    {
        const Judgement judgement = ask(kind.make(random));
        ++figures.trials;
        figures.observe(judgement.error);
        if (judgement.broken != nullptr)
        {
            figures.flag(figures.name + ", case " + std::to_string(i) + ": " + judgement.broken);
        }
    }
    return figures;
}

Case of_triangles(const TrianglePair& pair)
{
    const std::array<Vec3, 6> all{pair.first[0],  pair.first[1],  pair.first[2],
                                  pair.second[0], pair.second[1], pair.second[2]};
    const ClosestPoints answer = closest_points(pair.first, pair.second);
    return {answer,
            [pair] { return ShapeOracle<long double>::distance(pair.first, pair.second); },
            [pair] { return ShapeOracle<Quad>::distance(pair.first, pair.second); },
            [pair, answer](const Vec3& point)
            { return off_place(point, pair.first, answer.shape_feature); },
            pair.second,
            largest_coordinate_of(all),
            longest_way(all)};
}

Case of_segment(const TrianglePair& pair)
{
    const Segment segment = pair.segment();
    const std::array<Vec3, 2> ends{segment.from, segment.to};
    const std::array<Vec3, 5> all{ends[0], ends[1], pair.second[0], pair.second[1], pair.second[2]};
    const ClosestPoints answer = closest_points(segment, pair.second);
    return {answer,
            [=] { return ShapeOracle<long double>::distance(ends, pair.second); },
            [=] { return ShapeOracle<Quad>::distance(ends, pair.second); },
            [=](const Vec3& point) {
                return off_place(point, {ends[0], ends[1], ends[1]}, answer.shape_feature);
            },
            pair.second,
            largest_coordinate_of(all),
            longest_way(all)};
}

Case of_box(const BoxScene& scene)
{
    std::array<Vec3, 11> all{scene.triangle[0], scene.triangle[1], scene.triangle[2]};
    for (std::size_t i = 0; i < 8; ++i)
    {
        all[3 + i] = scene.box.half.cwiseProduct(
            Vec3((i & 1U) == 0 ? 1 : -1, (i & 2U) == 0 ? 1 : -1, (i & 4U) == 0 ? 1 : -1));
    }
    return {closest_points(scene.box, scene.triangle),
            [=] { return ShapeOracle<long double>::distance(scene.box, scene.triangle); },
            [=] { return ShapeOracle<Quad>::distance(scene.box, scene.triangle); },
            [=](const Vec3& point)
            { return (point.cwiseAbs() - scene.box.half).cwiseMax(0.0).norm(); },
            scene.triangle,
            largest_coordinate_of(all),
            longest_way(all)};
}

/// Judges any round shape whose core is `core_distance` away, in wide numbers.
Judgement judge_round(const ClosestPoints& answer, double radius, Quad core_distance,
                      double magnitude)
{
    const auto off = static_cast<double>(core_distance - static_cast<Quad>(radius) -
                                         static_cast<Quad>(answer.distance));
    const double touching = 1e-17 * magnitude; // Remainder of wide numbers on thin faces.
    const double error = share(std::max(0.0, std::abs(off) - touching), answer.distance_error);
    if (!is_finite(answer))
    {
        return {error, "not finite"};
    }
    if (std::abs(off) > answer.distance_error + touching)
    {
        return {error, "a distance off by more than its error"};
    }
    if (answer.meet != (answer.distance <= 0.0))
    {
        return {error, "a meeting that the distance contradicts"};
    }
    const double slack = answer.distance_error + 1e-15 * (magnitude + radius);
    const bool has_gap = answer.distance > -radius;
    if ((answer.on_triangle - answer.on_shape - answer.gap).norm() > slack ||
        (has_gap && std::abs(answer.gap.norm() - std::abs(answer.distance)) > slack))
    {
        return {error, "a gap that is not between the points"};
    }
    return {error, nullptr};
}

double magnitude_of(const TrianglePair& pair)
{
    return std::max(largest_coordinate_of(pair.first), largest_coordinate_of(pair.second));
}

/// Random radius, sometimes exactly the distance, so that the shape touches.
double some_radius(Random& random, double distance, double magnitude)
{
    return random.one_in(3) ? distance : magnitude * std::exp2(random.between(-20.0, 1.0));
}

Judgement judge_point(const TrianglePair& pair, Random& random)
{
    const Vec3 point = pair.first[random.below(3)];
    const ClosestPoint answer = closest_point_on_triangle(point, pair.second);
    const double distance = std::sqrt(answer.distance_sq);
    if (!std::isfinite(distance) || !std::isfinite(answer.distance_error) ||
        !answer.point.allFinite())
    {
        return {0.0, "not finite"};
    }
    const auto off = std::abs(static_cast<double>(QuadDistanceOracle::distance(point, pair.second) -
                                                  static_cast<Quad>(distance)));
    return {share(off, answer.distance_error),
            off > answer.distance_error ? "a distance off by more than its error" : nullptr};
}

Judgement judge_sphere(const TrianglePair& pair, Random& random)
{
    const Vec3 center = pair.first[random.below(3)];
    const Quad distance = QuadDistanceOracle::distance(center, pair.second);
    const double size = magnitude_of(pair);
    const double radius = some_radius(random, static_cast<double>(distance), size);
    return judge_round(closest_points(Sphere{center, radius}, pair.second), radius, distance, size);
}

Judgement judge_capsule(const TrianglePair& pair, Random& random)
{
    const Segment core = pair.segment();
    const std::array<Vec3, 2> ends{core.from, core.to};
    const auto distance = ShapeOracle<long double>::distance(ends, pair.second);
    const double size = magnitude_of(pair);
    const double radius = some_radius(random, static_cast<double>(distance), size);
    const ClosestPoints answer = closest_points(Capsule{core, radius}, pair.second);
    const long double off = std::abs(distance - static_cast<long double>(radius) -
                                     static_cast<long double>(answer.distance));
    const bool is_clear = off < 0.5L * static_cast<long double>(answer.distance_error);
    return judge_round(answer, radius,
                       is_clear ? static_cast<Quad>(distance)
                                : ShapeOracle<Quad>::distance(ends, pair.second),
                       size);
}

TrialFigures run_points(const PairClass& kind, int cases, Random& random)
{
    return run_cases("point", kind, cases, random,
                     [&](const TrianglePair& pair) { return judge_point(pair, random); });
}

TrialFigures run_segments(const PairClass& kind, int cases, Random& random)
{
    return run_cases("segment", kind, cases, random,
                     [](const TrianglePair& pair) { return judge(of_segment(pair)); });
}

TrialFigures run_triangles(const PairClass& kind, int cases, Random& random)
{
    return run_cases("triangle", kind, cases, random,
                     [](const TrianglePair& pair) { return judge(of_triangles(pair)); });
}

TrialFigures run_boxes(const PairClass& kind, int cases, Random& random)
{
    return run_cases("box", kind, cases, random,
                     [&](const TrianglePair& pair)
                     { return judge(of_box(box_scene(pair, random))); });
}

TrialFigures run_spheres(const PairClass& kind, int cases, Random& random)
{
    return run_cases("sphere", kind, cases, random,
                     [&](const TrianglePair& pair) { return judge_sphere(pair, random); });
}

TrialFigures run_capsules(const PairClass& kind, int cases, Random& random)
{
    return run_cases("capsule", kind, cases, random,
                     [&](const TrianglePair& pair) { return judge_capsule(pair, random); });
}

} // namespace

const std::array<KernelTrial, kKernelTrials>& kernel_trials()
{
    static const std::array<KernelTrial, kKernelTrials> trials{{{"point", run_points},
                                                                {"segment", run_segments},
                                                                {"triangle", run_triangles},
                                                                {"box", run_boxes},
                                                                {"sphere", run_spheres},
                                                                {"capsule", run_capsules}}};
    return trials;
}

} // namespace tactus::test
