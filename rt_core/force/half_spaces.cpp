// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/half_spaces.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus
{

namespace
{

/// Planes that hold the motion now: their normals, factored as Q x R with Q orthonormal and R upper
/// triangular, and a multiplier for each.
template <int N>
class HoldingPlanes
{
public:
    /// A further normal, split into a part along the holding normals and a part across them.
    struct Split
    {
        /// Part in the span of the holding normals, as coefficients of Q's columns.
        Motion<N> along{Motion<N>::Zero()};
        Motion<N> across{Motion<N>::Zero()}; ///< Part perpendicular to all holding normals.
        /// Coefficients of the holding normals of which `along` is the sum.
        Motion<N> shares{Motion<N>::Zero()};
    };

    [[nodiscard]] int size() const noexcept { return size_; }
    [[nodiscard]] std::uint32_t plane(int i) const noexcept { return planes_[slot(i)]; }
    [[nodiscard]] double multiplier(int i) const noexcept { return multipliers_[i]; }
    [[nodiscard]] bool has(std::uint32_t plane) const noexcept
    {
        const auto* const end = planes_.begin() + size_;
        return std::find(planes_.begin(), end, plane) != end;
    }

    [[nodiscard]] Split split(const Motion<N>& normal) const noexcept
    {
        Split result;
        result.across = normal;
        // One pass of Gram-Schmidt leaves rounding residues; two suffice.
        for (int pass = 0; pass < 2; ++pass)
        {
            for (int i = 0; i < size_; ++i)
            {
                const double part = q_[slot(i)].dot(result.across);
                result.along[i] += part;
                result.across -= part * q_[slot(i)];
            }
        }
        result.shares = solve_upper(result.along);
        return result;
    }

    void add(std::uint32_t plane, const Motion<N>& normal, double multiplier,
             const Split& normal_split) noexcept
    {
        TACTUS_ASSERT(size_ < N);
        const double length = normal_split.across.norm();
        TACTUS_ASSERT(length > 0.0);
        TACTUS_ASSERT(multiplier >= 0.0);
        planes_[slot(size_)] = plane;
        normals_[slot(size_)] = normal;
        multipliers_[size_] = multiplier;
        q_[slot(size_)] = normal_split.across / length;
        r_[slot(size_)] = normal_split.along;
        r_[slot(size_)][size_] = length;
        ++size_;
    }

    void drop(int dropped) noexcept
    {
        TACTUS_ASSERT(dropped < size_);
        const HoldingPlanes before = *this;
        size_ = dropped;
        for (int i = dropped + 1; i < before.size_; ++i)
        {
            const Motion<N>& normal = before.normals_[slot(i)];
            add(before.planes_[slot(i)], normal, before.multipliers_[i], split(normal));
        }
    }

    /// Lowers the multipliers by `step` times their shares, never below zero.
    void lower(const Motion<N>& shares, double step) noexcept
    {
        TACTUS_ASSERT(step >= 0.0);
        for (int i = 0; i < size_; ++i)
        {
            multipliers_[i] = std::max(0.0, multipliers_[i] - step * shares[i]);
        }
    }

    /// Returns the motion nearest to `wanted` that lies on all holding planes, and sets the
    /// multipliers.
    [[nodiscard]] Motion<N> settle(std::span<const HalfSpace<N>> planes,
                                   const Motion<N>& wanted) noexcept
    {
        Motion<N> motion = wanted;
        Motion<N> steps = Motion<N>::Zero();
        for (int i = 0; i < size_; ++i)
        {
            double left = planes[plane(i)].offset - normals_[slot(i)].dot(wanted);
            for (int k = 0; k < i; ++k)
            {
                left -= r_[slot(i)][k] * steps[k];
            }
            steps[i] = left / r_[slot(i)][i];
            motion += steps[i] * q_[slot(i)];
        }
        multipliers_ = solve_upper(steps);
        for (int i = 0; i < size_; ++i)
        {
            multipliers_[i] = std::max(0.0, multipliers_[i]);
        }
        return motion;
    }

private:
    [[nodiscard]] static constexpr std::size_t slot(int i) noexcept
    {
        return static_cast<std::size_t>(i);
    }

    [[nodiscard]] Motion<N> solve_upper(const Motion<N>& right) const noexcept
    {
        Motion<N> result = Motion<N>::Zero();
        for (int i = size_ - 1; i >= 0; --i)
        {
            double left = right[i];
            for (int k = i + 1; k < size_; ++k)
            {
                left -= r_[slot(k)][i] * result[k];
            }
            result[i] = left / r_[slot(i)][i];
        }
        return result;
    }

    int size_{0};
    std::array<std::uint32_t, static_cast<std::size_t>(N)> planes_{};
    std::array<Motion<N>, static_cast<std::size_t>(N)> normals_{};
    std::array<Motion<N>, static_cast<std::size_t>(N)> q_{};
    std::array<Motion<N>, static_cast<std::size_t>(N)> r_{}; ///< Columns of R.
    Motion<N> multipliers_{Motion<N>::Zero()};
};

/// One search for the nearest motion.
template <int N>
class Projection
{
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): arrays: only what is used is set.
    Projection(std::span<const HalfSpace<N>> planes, const Motion<N>& wanted) noexcept
        : planes_(planes), wanted_(wanted), motion_(wanted), wanted_length_(wanted.norm())
    {
    }

    /// Finds the motion; false if no motion is allowed by all planes.
    [[nodiscard]] bool try_find() noexcept
    {
        while (rounds_ > 0)
        {
            const std::uint32_t worst = most_violated();
            if (worst == planes_.size())
            {
                return true;
            }
            if (!try_hold(worst) && !try_let_pass(worst))
            {
                return false;
            }
        }
        return false;
    }

    [[nodiscard]] NearestMotion<N> result() const noexcept
    {
        NearestMotion<N> result;
        result.motion = motion_;
        for (int i = 0; i < holding_.size(); ++i)
        {
            result.held_by.push_back(holding_.plane(i));
            result.reactions[static_cast<std::size_t>(i)] = holding_.multiplier(i);
        }
        return result;
    }

private:
    /// Index of the plane that the motion violates most; the number of planes if none is violated.
    [[nodiscard]] std::uint32_t most_violated() noexcept
    {
        const double size = wanted_length_ + motion_.norm();
        auto worst = static_cast<std::uint32_t>(planes_.size());
        double most = 0.0;
        for (std::uint32_t i = 0; i < planes_.size(); ++i)
        {
            const double violation = planes_[i].offset - planes_[i].normal.dot(motion_);
            if (!(violation > 0.0))
            {
                continue; // This is the usual case: most planes are not violated.
            }
            if ((measured_ >> i & 1U) == 0)
            {
                lengths_[i] = planes_[i].normal.norm();
                measured_ |= std::uint64_t{1} << i;
            }
            if (!(violation > most * lengths_[i]))
            {
                continue;
            }
            const double rounding =
                tolerance(i) * (std::abs(planes_[i].offset) + lengths_[i] * size);
            if (violation > rounding && !holding_.has(i))
            {
                worst = i;
                most = violation / lengths_[i];
            }
        }
        return worst;
    }

    /// Tolerance of a plane's violation. A long search cycles within the slack of dependent
    /// normals, and gets the wide tolerance.
    [[nodiscard]] double tolerance(std::uint32_t plane) const noexcept
    {
        const bool is_wide = rounds_ < kConstraintRounds / 2 || (let_pass_ >> plane & 1U) != 0;
        return is_wide ? kSqueezeTolerance : kPlaneTolerance;
    }

    /// Pushes the motion out of a plane and drops planes that no longer hold it. False, with
    /// nothing changed, if that is impossible.
    [[nodiscard]] bool try_hold(std::uint32_t plane) noexcept
    {
        const Motion<N>& normal = planes_[plane].normal;
        std::optional<HoldingPlanes<N>> held_before; // State before the first plane is dropped.
        const Motion<N> motion_before = motion_;
        double multiplier = 0.0;
        while (rounds_ > 0)
        {
            --rounds_;
            const auto split = holding_.split(normal);
            const bool is_free =
                holding_.size() < N && split.across.norm() > kParallelPlanes * lengths_[plane];
            const double across_sq = split.across.squaredNorm();
            const double violation = planes_[plane].offset - normal.dot(motion_);
            const double whole = is_free ? std::max(0.0, violation) / across_sq : kInfinity;
            const LetGo first = first_to_let_go(split.shares, lengths_[plane]);
            const double step = std::min(whole, first.step);
            if (!(step < kInfinity))
            {
                break; // The holding planes and this plane exclude each other.
            }
            multiplier += step;
            if (whole <= first.step)
            {
                holding_.lower(split.shares, step);
                holding_.add(plane, normal, multiplier, split);
                motion_ = holding_.settle(planes_, wanted_);
                return true;
            }
            if (!held_before)
            {
                held_before = holding_;
            }
            holding_.lower(split.shares, step);
            if (is_free)
            {
                motion_ += step * split.across;
            }
            holding_.drop(first.index);
        }
        if (held_before)
        {
            holding_ = *held_before;
            motion_ = motion_before;
        }
        return false;
    }

    /// Gives a plane the wide tolerance if it conflicts with the holding planes only within the
    /// slack of dependent normals. False if the conflict is larger.
    [[nodiscard]] bool try_let_pass(std::uint32_t plane) noexcept
    {
        const double violation = planes_[plane].offset - planes_[plane].normal.dot(motion_);
        const double size = wanted_length_ + motion_.norm();
        const std::uint64_t bit = std::uint64_t{1} << plane;
        const bool passes = (let_pass_ & bit) == 0 &&
                            violation <= kSqueezeTolerance * (std::abs(planes_[plane].offset) +
                                                              lengths_[plane] * size);
        let_pass_ |= bit;
        return passes;
    }

    struct LetGo
    {
        double step{kInfinity};
        int index{0};
    };

    /// Finds the holding plane whose multiplier reaches zero first while that of the new plane
    /// grows.
    [[nodiscard]] LetGo first_to_let_go(const Motion<N>& shares, double length) const noexcept
    {
        LetGo first;
        for (int i = 0; i < holding_.size(); ++i)
        {
            // A share that is only rounding must not be a divisor.
            if (shares[i] * lengths_[holding_.plane(i)] <= kPlaneTolerance * length)
            {
                continue;
            }
            const double step = holding_.multiplier(i) / shares[i];
            if (step < first.step)
            {
                first = {step, i};
            }
        }
        return first;
    }

    std::span<const HalfSpace<N>> planes_;
    Motion<N> wanted_;
    Motion<N> motion_;
    HoldingPlanes<N> holding_;
    double wanted_length_;
    // Norms of the normals of planes that were violated. They are set when needed: zeros for all
    // would cost more than a search.
    std::array<double, kMaxHalfSpaces> lengths_;
    static_assert(kMaxHalfSpaces <= 64);
    std::uint64_t measured_{0}; ///< Planes whose norm is known, one bit each.
    std::uint64_t let_pass_{0}; ///< Planes with the wide tolerance, one bit each.
    std::uint32_t rounds_{kConstraintRounds};
};

} // namespace

template <int N>
NearestMotion<N> nearest_motion(std::span<const HalfSpace<N>> planes,
                                const Motion<N>& wanted) noexcept
{
    TACTUS_ASSERT(planes.size() <= kMaxHalfSpaces);
    Projection<N> projection(planes, wanted);
    if (projection.try_find())
    {
        return projection.result();
    }
    NearestMotion<N> none;
    none.is_feasible = false;
    return none;
}

template NearestMotion<3> nearest_motion<3>(std::span<const HalfSpace<3>>,
                                            const Motion<3>&) noexcept TACTUS_NONBLOCKING;
template NearestMotion<6> nearest_motion<6>(std::span<const HalfSpace<6>>,
                                            const Motion<6>&) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
