// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/nearest_walk.hpp"
#include "tests/unit/rt_core/tree_support.hpp"
#include "tests/unit/rt_core/tree_volumes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

namespace
{

constexpr auto& kDirections = VolumeDirections<Dop18Volume>::kAll;

long double along(const Vec3f& point, std::size_t direction)
{
    long double sum = 0.0L;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        sum += kDirections[direction][axis] * static_cast<long double>(point[axis]);
    }
    return sum;
}

bool holds(const Dop18& volume, const Vec3f& point)
{
    for (std::size_t i = 0; i < kDirections.size(); ++i)
    {
        const long double at = along(point, i);
        if (at < static_cast<long double>(volume.low[i]) ||
            at > static_cast<long double>(volume.high[i]))
        {
            return false;
        }
    }
    return true;
}

/// Rows of 16 vertices in a small cloud somewhere in the cube of `size`.
struct Cloud
{
    alignas(64) std::array<std::array<float, 16>, 3> rows{};

    Cloud(Random& random, double size)
    {
        const Vec3 center = random.in_cube(size);
        const double spread = size * std::exp2(-random.between(0.0, 12.0));
        for (std::size_t i = 0; i < 16; ++i)
        {
            const Vec3f point = to_float(center + random.in_cube(spread));
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                rows[axis][i] = point[axis];
            }
        }
    }
    [[nodiscard]] Vec3f point(std::size_t i) const { return {rows[0][i], rows[1][i], rows[2][i]}; }
    [[nodiscard]] Dop18 volume(std::uint32_t mask) const
    {
        return Dop18Volume::of_vertices(portable_kernels(), rows.front().data(), mask);
    }
};

/// What child_gaps() bounds, in quanta: the greatest of box and slab distances.
long double true_gap(const Dop18& volume, const Vec3& point_m, double quantum_m)
{
    std::array<long double, 9> gaps{};
    for (std::size_t i = 0; i < kDirections.size(); ++i)
    {
        long double at = 0.0L;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            at += kDirections[i][axis] *
                  static_cast<long double>(point_m[static_cast<Eigen::Index>(axis)]);
        }
        gaps[i] = std::max({static_cast<long double>(volume.low[i]) - at,
                            at - static_cast<long double>(volume.high[i]), 0.0L});
    }
    long double greatest = std::sqrt(gaps[0] * gaps[0] + gaps[1] * gaps[1] + gaps[2] * gaps[2]);
    for (std::size_t i = 3; i < gaps.size(); ++i)
    {
        greatest = std::max(greatest, gaps[i] / std::sqrt(2.0L));
    }
    return greatest / static_cast<long double>(quantum_m);
}

} // namespace

TEST(Dop18Volume, is_the_tightest_in_floats_around_the_vertices_in_the_mask)
{
    Random random(90);
    for (int round = 0; round < 2'000; ++round)
    {
        const Cloud cloud(random, std::exp2(random.between(-20.0, 20.0)));
        const std::uint32_t mask = random.below(0x1'0000) | (1U << random.below(16));
        const Dop18 sut = cloud.volume(mask);
        for (std::size_t i = 0; i < kDirections.size(); ++i)
        {
            bool low_is_needed = false;
            bool high_is_needed = false;
            for (std::size_t vertex = 0; vertex < 16; ++vertex)
            {
                const bool used = ((mask >> vertex) & 1U) != 0;
                ASSERT_TRUE(!used || holds(sut, cloud.point(vertex))) << round;
                const long double at = along(cloud.point(vertex), i);
                low_is_needed |= used && at < static_cast<long double>(next_up(sut.low[i]));
                high_is_needed |= used && at > static_cast<long double>(next_down(sut.high[i]));
            }
            ASSERT_TRUE(low_is_needed && high_is_needed) << round << " direction " << i;
        }
    }
}

TEST(Dop18Volume, of_no_vertices_and_of_no_children_is_empty)
{
    Random random(91);
    const Cloud cloud(random, 1.0);

    EXPECT_EQ(cloud.volume(0), Dop18{});
    EXPECT_EQ(Dop18Volume::of_children(portable_kernels(), Dop18Volume::Rows{}, 0), Dop18{});
}

TEST(Dop18Volume, of_children_holds_what_they_hold_and_nothing_more)
{
    Random random(92);
    for (int round = 0; round < 500; ++round)
    {
        Dop18Volume::Rows rows;
        const std::uint32_t mask = random.below(256);
        Dop18 expected;
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const Dop18 volume = Cloud(random, 10.0).volume(0xFFFF);
            rows.set(child, volume);
            ASSERT_EQ(rows.get(child), volume);
            for (std::size_t i = 0; i < kDirections.size() && ((mask >> child) & 1U) != 0; ++i)
            {
                expected.low[i] = std::min(expected.low[i], volume.low[i]);
                expected.high[i] = std::max(expected.high[i], volume.high[i]);
            }
        }
        ASSERT_EQ(Dop18Volume::of_children(portable_kernels(), rows, mask), expected) << round;
    }
}

TEST(Dop18Volume, grows_along_each_direction_by_the_error_times_its_length)
{
    Random random(93);
    for (int round = 0; round < 2'000; ++round)
    {
        const Dop18 before = Cloud(random, 4.0).volume(0xFFFF);
        const auto margin = static_cast<float>(std::exp2(random.between(-20.0, 4.0)));
        const Dop18 after = before.inflated(margin);
        for (std::size_t i = 0; i < kDirections.size(); ++i)
        {
            const long double length = i < 3 ? 1.0L : std::sqrt(2.0L);
            const long double wanted = static_cast<long double>(margin) * length;
            const long double below =
                static_cast<long double>(before.low[i]) - static_cast<long double>(after.low[i]);
            const long double above =
                static_cast<long double>(after.high[i]) - static_cast<long double>(before.high[i]);
            const long double slack = 64.0L * 0x1p-23L; // Two roundings of numbers below 64.
            ASSERT_TRUE(below >= wanted && below <= wanted + slack) << round << " " << i;
            ASSERT_TRUE(above >= wanted && above <= wanted + slack) << round << " " << i;
        }
    }
}

TEST(Dop18Volume, gaps_are_below_the_distance_to_slabs_by_no_more_than_stated)
{
    Random random(94);
    for (int round = 0; round < 3'000; ++round)
    {
        const double size = std::exp2(random.between(-8.0, 8.0));
        Dop18Volume::Rows rows;
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            rows.set(child, Cloud(random, size).volume(0xFFFF));
        }
        const Vec3 point = random.in_cube(size * std::exp2(random.between(-2.0, 16.0)));
        const KernelProbe probe = make_probe(point, kTreeQuantum);
        const auto bound = static_cast<float>(size * random.between(0.0, 2.0) / 0x1p-10);
        const std::uint32_t mask = random.below(256);
        alignas(32) std::array<float, kNodeChildren> gaps{};

        const std::uint32_t near =
            Dop18Volume::child_gaps(portable_kernels(), rows, probe, mask, bound, gaps.data());

        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const long double truth = true_gap(rows.get(child), point, 0x1p-10);
            const auto gap = static_cast<long double>(gaps[child]);
            const auto slack = static_cast<long double>(probe.slack);
            ASSERT_LE(gap, truth) << round;
            ASSERT_GE(gap, truth * (1.0L - 0x1p-19L) - 8.0L * slack) << round;
            const bool is_near = ((mask >> child) & 1U) != 0 && gaps[child] <= bound;
            ASSERT_EQ((near >> child) & 1U, is_near ? 1U : 0U) << round;
        }
    }
}

TEST(Dop18Volume, a_diagonal_edge_is_farther_than_its_box)
{
    Cloud cloud = []
    {
        Random random(95);
        return Cloud(random, 1.0);
    }();
    for (std::size_t i = 0; i < 16; ++i)
    {
        const float t = static_cast<float>(i) / 16.0F;
        cloud.rows[0][i] = t;
        cloud.rows[1][i] = t;
        cloud.rows[2][i] = 0.0F;
    }
    Dop18Volume::Rows rows;
    rows.set(0, cloud.volume(0xFFFF));
    alignas(32) std::array<float, kNodeChildren> gaps{};

    const KernelProbe probe = make_probe({0.9, 0.1, 0.0}, kTreeQuantum); // Inside the box.
    Dop18Volume::child_gaps(portable_kernels(), rows, probe, 1U, 1e9F, gaps.data());

    EXPECT_NEAR(static_cast<double>(gaps[0]), 0.8 / std::sqrt(2.0) * 1024.0, 1e-2);
}

template <typename Tree>
class NearestWalkOfAnyVolume : public testing::Test
{
};
TYPED_TEST_SUITE(NearestWalkOfAnyVolume, TreesOfAllVolumes, VolumeNames);

TYPED_TEST(NearestWalkOfAnyVolume, finds_the_least_distance_minus_error_of_all_faces)
{
    Random random(96);
    for (const FaceStyle& style : face_styles())
    {
        for (const bool exact : {true, false})
        {
            BasicTreeRig<TypeParam> rig({300, 400, 400});
            for (std::uint32_t prim = 0; prim < 300; ++prim)
            {
                ChangedFace face = random_face(random, style, prim, prim);
                face.error = exact ? ErrorCode{0} : face.error;
                rig.put(face);
            }
            rig.sut->refit();
            ASSERT_EQ(rig.faults(), "");
            NearestWalk sut(*rig.sut);
            for (int i = 0; i < 150; ++i)
            {
                const Vec3 point = random.in_cube(random.one_in(4) ? 1e4 : 3.0);
                const double band = random.one_in(2) ? 1.0 : 1e9;
                long double truth = std::numeric_limits<long double>::infinity();
                for (const ChangedFace& face : rig.present())
                {
                    truth = std::min(truth,
                                     DistanceOracle::distance(point, to_triangle(face.corners_m)) -
                                         static_cast<long double>(error_in_quanta(face.error)) *
                                             static_cast<long double>(kTreeQuantum));
                }
                const double answer = sut.least_m(point, band);
                if (std::isinf(answer))
                {
                    ASSERT_GT(truth, static_cast<long double>(band) * (1.0L - 1e-12L));
                    continue;
                }
                ASSERT_NEAR(answer, static_cast<double>(truth), 1e-11 * (1.0 + point.norm()))
                    << style.name;
            }
            EXPECT_GT(sut.visits(), 0U);
        }
    }
}

} // namespace tactus::test
