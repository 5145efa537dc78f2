// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/shape_scenes.hpp"

#include <cmath>
#include <cstdlib>

namespace tactus::test
{

namespace
{

Triangle generic_triangle(Random& random)
{
    return {random.in_cube(1.0), random.in_cube(1.0), random.in_cube(1.0)};
}

double small(Random& random, double least_log2)
{
    return std::exp2(random.between(least_log2, 0.0));
}

/// Needle up to aspect 1e8.
Triangle needle(Random& random)
{
    const Vec3 end = random.in_cube(1.0);
    return {random.in_cube(1.0), end, end + random.in_cube(small(random, -27.0))};
}

Triangle cap(Random& random)
{
    const Vec3 from = random.in_cube(1.0);
    const Vec3 to = random.in_cube(1.0);
    const Vec3 foot = from + random.between(0.0, 1.0) * (to - from);
    return {from, foot + random.in_cube(small(random, -27.0)), to};
}

Triangle two_equal_corners(Random& random)
{
    const Vec3 a = random.in_cube(1.0);
    const Vec3 b = random.in_cube(1.0);
    const std::array<Triangle, 3> triangles{Triangle{a, a, b}, Triangle{a, b, a},
                                            Triangle{b, a, a}};
    return triangles[random.below(3)];
}

Triangle all_equal_corners(Random& random)
{
    const Vec3 a = random.in_cube(1.0);
    return {a, a, a};
}

Vec3 on_grid(Random& random, std::uint32_t steps)
{
    const double x = random.below(steps);
    const double y = random.below(steps);
    const double z = random.below(steps);
    return {x, y, z};
}

/// Collinear triangle, exactly (small integers) or as nearly as doubles permit.
Triangle collinear(Random& random)
{
    if (random.one_in(2))
    {
        const Vec3 a = on_grid(random, 4);
        const Vec3 step = on_grid(random, 3);
        return {a, a + step * random.below(4), a + step * random.below(4)};
    }
    const Vec3 a = random.in_cube(1.0);
    const Vec3 b = random.in_cube(1.0);
    return {a, b, a + random.between(-1.0, 2.0) * (b - a)};
}

Vec3 place_on(const Triangle& triangle, Random& random)
{
    double a = random.between(0.0, 1.0);
    double b = random.between(0.0, 1.0);
    if (a + b > 1.0)
    {
        a = 1.0 - a;
        b = 1.0 - b;
    }
    switch (random.below(3))
    {
    case 0:
        return triangle[random.below(3)];
    case 1:
        return triangle[0] + a * (triangle[1] - triangle[0]);
    default:
        return triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
    }
}

Triangle moved(const Triangle& triangle, const Vec3& way)
{
    return {triangle[0] + way, triangle[1] + way, triangle[2] + way};
}

/// The second triangle has a place at distance `gap` from a place on the first.
TrianglePair near_one_another(const Triangle& first, const Triangle& second, double gap,
                              Random& random)
{
    const Vec3 here = place_on(first, random);
    const Vec3 there = place_on(second, random);
    return {first, moved(second, here - there + random.in_cube(gap))};
}

TrianglePair somehow_placed(const Triangle& first, const Triangle& second, Random& random)
{
    switch (random.below(4))
    {
    case 0:
        return {first, second};
    case 1:
        return {first, moved(second, random.in_cube(3.0))};
    default:
        return near_one_another(first, second, small(random, -50.0), random);
    }
}

/// Pair in which one or both come from `make`.
template <typename Make>
TrianglePair with(Make make, Random& random)
{
    const std::uint32_t which = random.below(3);
    const Triangle first = which == 0 ? generic_triangle(random) : make(random);
    const Triangle second = which == 1 ? generic_triangle(random) : make(random);
    return somehow_placed(first, second, random);
}

TrianglePair generic(Random& random)
{
    return with(generic_triangle, random);
}
TrianglePair needles(Random& random)
{
    return with(needle, random);
}
TrianglePair caps(Random& random)
{
    return with(cap, random);
}
TrianglePair with_two_equal_corners(Random& random)
{
    return with(two_equal_corners, random);
}
TrianglePair with_all_equal_corners(Random& random)
{
    return with(all_equal_corners, random);
}
TrianglePair with_collinear_corners(Random& random)
{
    return with(collinear, random);
}

/// Pair in one plane exactly: combinations of two directions of small integers.
TrianglePair coplanar(Random& random)
{
    const Vec3 u = on_grid(random, 5) - Vec3(2, 2, 2);
    const Vec3 v = on_grid(random, 5) - Vec3(2, 2, 2);
    const Vec3 origin = on_grid(random, 5);
    const double step = std::ldexp(1.0, -static_cast<int>(random.below(20)));
    const auto corner = [&]
    {
        const Vec3 along = origin + random.below(64) * u;
        return Vec3((along + random.below(64) * v) * step);
    };
    return {{corner(), corner(), corner()}, {corner(), corner(), corner()}};
}

TrianglePair with_shared_corner(Random& random)
{
    TrianglePair pair{generic_triangle(random), generic_triangle(random)};
    pair.second[random.below(3)] = pair.first[random.below(3)];
    return pair;
}

TrianglePair with_shared_edge(Random& random)
{
    TrianglePair pair{random.one_in(2) ? generic_triangle(random) : needle(random),
                      generic_triangle(random)};
    const std::uint32_t i = random.below(3);
    const std::uint32_t j = random.below(3);
    pair.second[j] = pair.first[i];
    pair.second[(j + 1) % 3] = pair.first[(i + 1 + random.below(2)) % 3];
    return pair;
}

TrianglePair grazing(Random& random)
{
    const Triangle first = generic_triangle(random);
    const Triangle second = generic_triangle(random);
    return near_one_another(first, second, 1e-12, random);
}

/// Pair with nearly parallel edges: to 1e-17, and exactly.
TrianglePair with_parallel_edges(Random& random)
{
    TrianglePair pair{generic_triangle(random), generic_triangle(random)};
    const double tilt = random.one_in(5) ? 0.0 : small(random, -56.0);
    const std::uint32_t i = random.below(3);
    const std::uint32_t j = random.below(3);
    const Vec3 edge = random.between(-2.0, 2.0) * (pair.first[(i + 1) % 3] - pair.first[i]);
    pair.second[(j + 1) % 3] = pair.second[j] + edge + random.in_cube(tilt);
    return somehow_placed(pair.first, pair.second, random);
}

/// Pair in nearly parallel planes, slightly apart.
TrianglePair layered(Random& random)
{
    const Triangle flat{Vec3{random.between(-1, 1), random.between(-1, 1), 0.0},
                        Vec3{random.between(-1, 1), random.between(-1, 1), 0.0},
                        Vec3{random.between(-1, 1), random.between(-1, 1), 0.0}};
    TrianglePair pair{flat, flat};
    const double tilt = random.one_in(5) ? 0.0 : small(random, -56.0);
    const double gap = small(random, -56.0);
    for (Vec3& corner : pair.second)
    {
        corner +=
            Vec3{random.between(-1, 1), random.between(-1, 1), gap + tilt * random.between(-1, 1)};
    }
    return pair;
}

TrianglePair scaled_pair(const TrianglePair& pair, double factor)
{
    TrianglePair result = pair;
    for (std::size_t i = 0; i < 3; ++i)
    {
        result.first[i] *= factor;
        result.second[i] *= factor;
    }
    return result;
}

TrianglePair any(Random& random)
{
    return pair_classes()[random.below(12)].make(random);
}

TrianglePair tiny(Random& random)
{
    return scaled_pair(any(random), 1e-6);
}
TrianglePair huge(Random& random)
{
    return scaled_pair(any(random), 1e6);
}

/// Pair rounded to the grid of 2e-9 that doubles have there.
TrianglePair far_away(Random& random)
{
    const TrianglePair pair = any(random);
    const Vec3 offset = random.in_cube(1e7);
    return {moved(pair.first, offset), moved(pair.second, offset)};
}

} // namespace

const std::array<PairClass, kPairClasses>& pair_classes()
{
    static const std::array<PairClass, kPairClasses> classes{{
        {"generic", generic},
        {"needles", needles},
        {"caps", caps},
        {"two_equal_corners", with_two_equal_corners},
        {"all_equal_corners", with_all_equal_corners},
        {"collinear", with_collinear_corners},
        {"coplanar", coplanar},
        {"shared_corner", with_shared_corner},
        {"shared_edge", with_shared_edge},
        {"grazing", grazing},
        {"parallel_edges", with_parallel_edges},
        {"layered", layered},
        {"tiny", tiny},
        {"huge", huge},
        {"far_away", far_away},
    }};
    return classes;
}

BoxScene box_scene(const TrianglePair& pair, Random& random)
{
    BoxScene scene{{pair.first[0].cwiseAbs()}, pair.second};
    if (random.one_in(8))
    {
        scene.box.half[static_cast<Eigen::Index>(random.below(3))] = 0.0;
    }
    if (random.one_in(2))
    {
        return scene;
    }
    Vec3 place = scene.box.half;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        const std::uint32_t where = random.below(3);
        place[axis] *= where == 0 ? -1.0 : (where == 1 ? 1.0 : random.between(-1.0, 1.0));
    }
    const double size = scene.box.half.maxCoeff();
    const Vec3 way = place - place_on(scene.triangle, random);
    scene.triangle = moved(scene.triangle, way + random.in_cube(size * small(random, -50.0)));
    return scene;
}

int cases_per_class()
{
    const char* text = std::getenv("TACTUS_KERNEL_CASES");
    return text == nullptr ? 2'000 : std::atoi(text);
}

} // namespace tactus::test
