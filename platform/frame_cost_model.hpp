// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Learns what a frame's work costs from frames as they come: a decayed least-squares plane
///
///     time = mean time + per_edit x (edits - mean edits) + per_step x (steps - mean steps)
///
/// An edit is a split or a merge, its share of the refit included; a step is a node or four
/// triangles of a traversal. The means follow in about kWindowFrames frames, and in the first ones
/// as fast as they can: frame n weighs 1/n. The slopes move only as far as the work varied; while
/// it does not, they stay what they were. Bounded work, same inputs give same bits.
class FrameCostModel
{
public:
    static constexpr double kWindowFrames = 128.0;
    /// Before anything is known: what one core of a small machine took, rounded up.
    static constexpr double kFirstPerEdit_ns = 500.0;
    static constexpr double kFirstPerStep_ns = 25.0;
    /// No slope leaves a range that is forty times wider on both sides: noise can't make work free.
    static constexpr double kSlopeRange = 40.0;

    void observe(double time_ns, double edits, double steps) noexcept;

    [[nodiscard]] double predict_ns(double edits, double steps) const noexcept
    {
        return time_ns_ + per_edit_ns_ * (edits - edits_) + per_step_ns_ * (steps - steps_);
    }
    [[nodiscard]] double per_edit_ns() const noexcept { return per_edit_ns_; }
    [[nodiscard]] double per_step_ns() const noexcept { return per_step_ns_; }

private:
    void follow_means(double time_ns, double edits, double steps, double weight) noexcept;
    void follow_slopes(double gain) noexcept;

    double frames_{0.0};
    double time_ns_{0.0};
    double edits_{0.0};
    double steps_{0.0};
    // Decayed (co)variances.
    double edits_edits_{0.0};
    double edits_steps_{0.0};
    double steps_steps_{0.0};
    double edits_time_{0.0};
    double steps_time_{0.0};
    double per_edit_ns_{kFirstPerEdit_ns};
    double per_step_ns_{kFirstPerStep_ns};
};

/// Follows the upper end of values that scatter: up by an eighth of the way at once, down by one
/// part in 256 a frame. Where values scatter evenly it comes to rest near the highest of 50.
class UpperLevel
{
public:
    explicit UpperLevel(double start) noexcept : level_(start) {}

    void observe(double value) noexcept
    {
        level_ += (value - level_) * (value > level_ ? 1.0 / 8.0 : 1.0 / 256.0);
    }
    [[nodiscard]] double level() const noexcept { return level_; }

private:
    double level_;
};

} // namespace tactus
