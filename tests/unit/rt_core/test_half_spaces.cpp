// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/limits.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus::test
{

namespace
{

template <int N>
using Planes = std::vector<HalfSpace<N>>;

template <int N>
Motion<N> in_cube(Random& random)
{
    Motion<N> result;
    for (int i = 0; i < N; ++i)
    {
        result[i] = random.between(-1.0, 1.0);
    }
    return result;
}

template <int N>
Motion<N> unit(Random& random)
{
    return in_cube<N>(random).normalized();
}

/// Nearest motion by trying all subsets of planes, in extended precision; empty if none is allowed.
template <int N>
class SubsetOracle
{
public:
    explicit SubsetOracle(const Planes<N>& planes, const Motion<N>& wanted)
        : planes_(planes), wanted_(wanted.template cast<long double>())
    {
        std::vector<std::size_t> subset;
        visit(0, subset);
    }
    [[nodiscard]] const std::optional<Motion<N>>& nearest() const { return nearest_; }

private:
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<long double, N, 1>;

    void visit(std::size_t from, std::vector<std::size_t>& subset)
    {
        try_subset(subset);
        for (std::size_t i = from; i < planes_.size() && subset.size() < N; ++i)
        {
            subset.push_back(i);
            visit(i + 1, subset);
            subset.pop_back();
        }
    }

    void try_subset(const std::vector<std::size_t>& subset)
    {
        Vector at = wanted_;
        if (!subset.empty())
        {
            Matrix normals(N, static_cast<Eigen::Index>(subset.size()));
            Eigen::Matrix<long double, Eigen::Dynamic, 1> left(normals.cols());
            for (std::size_t i = 0; i < subset.size(); ++i)
            {
                const auto column = static_cast<Eigen::Index>(i);
                normals.col(column) = planes_[subset[i]].normal.template cast<long double>();
                left[column] = static_cast<long double>(planes_[subset[i]].offset) -
                               normals.col(column).dot(wanted_);
            }
            const Eigen::FullPivLU<Matrix> lu(normals.transpose() * normals);
            if (!lu.isInvertible())
            {
                return;
            }
            at += normals * lu.solve(left);
        }
        for (const HalfSpace<N>& plane : planes_)
        {
            const Vector normal = plane.normal.template cast<long double>();
            if (normal.dot(at) < static_cast<long double>(plane.offset) - 1e-10L)
            {
                return;
            }
        }
        if (!nearest_ || (at - wanted_).norm() < distance_)
        {
            nearest_ = at.template cast<double>();
            distance_ = (at - wanted_).norm();
        }
    }

    const Planes<N>& planes_;
    Vector wanted_;
    std::optional<Motion<N>> nearest_;
    long double distance_{0.0L};
};

/// Karush-Kuhn-Tucker conditions, which only the nearest motion satisfies. Planes may be violated
/// by `tolerance` of the lengths.
template <int N>
void expect_nearest(const Planes<N>& planes, const Motion<N>& wanted, const NearestMotion<N>& sut,
                    double tolerance)
{
    ASSERT_TRUE(sut.is_feasible);
    ASSERT_LE(sut.held_by.size(), static_cast<std::size_t>(N));
    const double size = 1.0 + wanted.norm() + sut.motion.norm();
    Motion<N> sum = wanted;
    double reactions = 0.0;
    for (std::size_t i = 0; i < sut.held_by.size(); ++i)
    {
        const HalfSpace<N>& plane = planes[sut.held_by[i]];
        ASSERT_GE(sut.reactions[i], 0.0);
        ASSERT_NEAR(plane.normal.dot(sut.motion), plane.offset, 1e-11 * size);
        sum += sut.reactions[i] * plane.normal;
        reactions += sut.reactions[i];
    }
    ASSERT_LE((sum - sut.motion).norm(), 1e-9 * (size + reactions));
    for (const HalfSpace<N>& plane : planes)
    {
        ASSERT_GE(plane.normal.dot(sut.motion), plane.offset - tolerance * size);
    }
}

template <int N>
NearestMotion<N> nearest(const Planes<N>& planes, const Motion<N>& wanted)
{
    return nearest_motion<N>(std::span<const HalfSpace<N>>(planes), wanted);
}

/// Planes that all permit one motion, nearly degenerate: equal ones, rotated by 10^turn or more,
/// opposite, of a pencil through one axis, through one point.
template <int N>
Planes<N> awkward_planes(Random& random, std::size_t count, double turn_log10)
{
    const Motion<N> allowed = in_cube<N>(random);
    const Motion<N> axis = unit<N>(random);
    const bool all_touch = random.one_in(2);
    Planes<N> planes;
    while (planes.size() < count)
    {
        Motion<N> normal = unit<N>(random);
        if (!planes.empty())
        {
            const Motion<N> other = planes[random.below(planes.size())].normal;
            const double turn = std::pow(10.0, random.between(turn_log10, 0.0));
            switch (random.below(6U))
            {
            case 0:
                normal = other;
                break;
            case 1:
                normal = (other + turn * normal).normalized();
                break;
            case 2:
                normal = -other;
                break;
            case 3:
                normal = (normal - axis.dot(normal) * axis).normalized();
                break;
            default:
                break;
            }
        }
        const double room = all_touch || random.one_in(3) ? 0.0 : random.between(0.0, 1.0);
        planes.push_back({normal, normal.dot(allowed) - room});
    }
    return planes;
}

template <int N>
void expect_same_as_oracle(std::uint64_t own_seed, std::size_t planes_max)
{
    Random random(own_seed);
    int held = 0;
    int infeasible = 0;
    for (int round = 0; round < 400; ++round)
    {
        Planes<N> planes(random.below(planes_max + 1));
        for (HalfSpace<N>& plane : planes)
        {
            const Motion<N> normal = unit<N>(random);
            plane = {normal * random.between(0.1, 10.0), random.between(-0.6, 0.9)};
        }
        const Motion<N> wanted = in_cube<N>(random);
        const NearestMotion<N> sut = nearest(planes, wanted);
        const SubsetOracle<N> oracle(planes, wanted);
        ASSERT_EQ(sut.is_feasible, oracle.nearest().has_value()) << round;
        if (!sut.is_feasible)
        {
            ++infeasible;
            ASSERT_EQ(sut.motion, Motion<N>(Motion<N>::Zero()));
            ASSERT_TRUE(sut.held_by.empty());
            continue;
        }
        held += sut.held_by.empty() ? 0 : 1;
        ASSERT_LE((sut.motion - *oracle.nearest()).norm(), 1e-8) << round;
        expect_nearest(planes, wanted, sut, 1e-11);
        ASSERT_FALSE(testing::Test::HasFatalFailure()) << round;
    }
    EXPECT_GT(held, 100);
    EXPECT_GT(infeasible, 3);
}

template <int N>
void expect_conditions_of_awkward_planes(std::uint64_t own_seed)
{
    Random random(own_seed);
    for (int round = 0; round < 5'000; ++round)
    {
        const Planes<N> planes = awkward_planes<N>(random, 1 + random.below(kMaxHalfSpaces), -12.0);
        const Motion<N> wanted = 3.0 * in_cube<N>(random);
        expect_nearest(planes, wanted, nearest(planes, wanted), 5.0 * kSqueezeTolerance);
        ASSERT_FALSE(testing::Test::HasFatalFailure()) << round;
    }
}

template <int N>
void expect_no_order(std::uint64_t own_seed)
{
    Random random(own_seed);
    for (int round = 0; round < 500; ++round)
    {
        Planes<N> planes = awkward_planes<N>(random, 20, -1.0);
        const Motion<N> wanted = 3.0 * in_cube<N>(random);
        const NearestMotion<N> once = nearest(planes, wanted);
        ASSERT_EQ(nearest(planes, wanted).motion, once.motion) << round;
        for (std::size_t i = planes.size() - 1; i > 0; --i)
        {
            std::swap(planes[i], planes[random.below(i + 1)]);
        }
        ASSERT_LE((nearest(planes, wanted).motion - once.motion).norm(), 1e-9) << round;
    }
}

template <int N>
void expect_squeezing_planes_refused(std::uint64_t own_seed)
{
    Random random(own_seed);
    for (int round = 0; round < 2'000; ++round)
    {
        // Positive combinations of the normals are zero, those of the offsets positive.
        const std::size_t count = 2 + random.below(static_cast<std::size_t>(N));
        Planes<N> planes;
        Motion<N> last = Motion<N>::Zero();
        for (std::size_t i = 0; i + 1 < count; ++i)
        {
            const Motion<N> normal = unit<N>(random);
            last -= random.between(0.2, 1.0) * normal;
            planes.push_back({normal, 1e-3});
        }
        planes.push_back({last.normalized(), 1e-3});
        for (HalfSpace<N> other : awkward_planes<N>(random, 10, -12.0))
        {
            other.offset -= 5.0;
            planes.push_back(other);
        }
        ASSERT_FALSE(nearest(planes, in_cube<N>(random)).is_feasible) << round;
    }
}

} // namespace

TEST(HalfSpaces, a_gap_holds_from_both_sides_and_one_without_width_is_a_plane)
{
    const Planes<3> gap{{Vec3(0, 0, 1), -1.0}, {Vec3(0, 0, -1), -1.0}};
    const Planes<3> plane{{Vec3(0, 0, 1), 0.25}, {Vec3(0, 0, -1), -0.25}};

    EXPECT_EQ(nearest<3>(gap, Vec3(1, 0, 3)).motion, Vec3(1, 0, 1));
    EXPECT_EQ(nearest<3>(gap, Vec3(1, 0, -3)).motion, Vec3(1, 0, -1));
    EXPECT_EQ(nearest<3>(plane, Vec3(1, 0, -3)).motion, Vec3(1, 0, 0.25));
}

TEST(HalfSpaces, hold_what_is_beyond_them_by_more_than_the_tolerance)
{
    const Vec3 wanted(0, 0, 1);
    const double lengths = 1.0 + 2.0 * wanted.norm(); // Offset, wanted and found motion.
    for (const double share : {0.9, 1.1})
    {
        const Planes<3> planes{{Vec3(0, 0, 1), 1.0 + share * kPlaneTolerance * lengths}};
        EXPECT_EQ(nearest<3>(planes, wanted).held_by.empty(), share < 1.0);
    }
}

TEST(HalfSpaces, face_each_other_as_a_gap_up_to_the_angle_of_parallel_ones_and_then_as_a_wedge)
{
    for (const double share : {0.9, 1.1})
    {
        const Planes<3> planes{{Vec3(0, 0, 1), 0.1}, {Vec3(share * kParallelPlanes, 0, -1), 0.1}};
        const NearestMotion<3> sut = nearest<3>(planes, Vec3(0, 0, 0));
        EXPECT_EQ(sut.is_feasible, share > 1.0);
        EXPECT_EQ(sut.motion.x() > 1e6, share > 1.0) << "the edge is far away";
    }
}

TEST(HalfSpaces, squeeze_when_their_gap_is_too_narrow_by_more_than_the_tolerance)
{
    const Vec3 wanted(0, 0, 1);
    for (const double share : {0.9, 1.1})
    {
        const double narrow = share * kSqueezeTolerance * (1.0 + 2.0 * wanted.norm());
        const Planes<3> planes{{Vec3(0, 0, 1), 1.0}, {Vec3(0, 0, -1), narrow - 1.0}};
        EXPECT_EQ(nearest<3>(planes, wanted).is_feasible, share < 1.0);
    }
}

TEST(HalfSpacesDeathTest, more_of_them_than_the_limit_are_a_bug)
{
    Planes<3> planes(kMaxHalfSpaces, {Vec3(0, 0, 1), -1.0});
    EXPECT_EQ(nearest<3>(planes, Vec3(0, 0, -2)).motion, Vec3(0, 0, -1));
    planes.push_back(planes.front());
    EXPECT_DEATH(static_cast<void>(nearest<3>(planes, Vec3(0, 0, 0))), "");
}

TEST(HalfSpaces, with_offsets_of_at_most_zero_always_allow_some_motion)
{
    static_assert(kConstraintRounds >= 2 * kMaxHalfSpaces, "each may join and leave");
    Random random(1);
    for (int round = 0; round < 2'000; ++round)
    {
        Planes<6> planes = awkward_planes<6>(random, kMaxHalfSpaces, -12.0);
        for (HalfSpace<6>& plane : planes)
        {
            plane.offset = random.one_in(2) ? 0.0 : -random.between(0.0, 1e-3);
        }
        const Motion<6> wanted = in_cube<6>(random);
        expect_nearest<6>(planes, wanted, nearest(planes, wanted), 5.0 * kSqueezeTolerance);
        ASSERT_FALSE(HasFatalFailure()) << round;
    }
}

TEST(HalfSpaces, hold_as_all_subsets_of_them_say)
{
    expect_same_as_oracle<3>(2, 14);
    expect_same_as_oracle<6>(3, 11);
}

TEST(HalfSpaces, that_are_awkward_hold_as_the_conditions_say)
{
    expect_conditions_of_awkward_planes<3>(4);
    expect_conditions_of_awkward_planes<6>(5);
}

TEST(HalfSpaces, are_the_same_in_any_order)
{
    expect_no_order<3>(6);
    expect_no_order<6>(7);
}

TEST(HalfSpaces, that_squeeze_are_refused)
{
    expect_squeezing_planes_refused<3>(8);
    expect_squeezing_planes_refused<6>(9);
}

} // namespace tactus::test
