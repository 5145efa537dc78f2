// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/run_series.hpp"

#include <algorithm>

namespace tactus::hrtc
{

void SeriesPoint::take(const SeriesPoint& other) noexcept
{
    force_n = std::max(force_n, other.force_n);
    width_m = std::max(width_m, other.width_m);
    frame_us = std::max(frame_us, other.frame_us);
    for (std::size_t i = 0; i < kStages; ++i)
    {
        stage_us[i] = std::max(stage_us[i], other.stage_us[i]);
    }
}

template <typename Point>
void Series<Point>::add(const Point& frame) noexcept
{
    constexpr std::size_t kHalf = kPoints / 2;
    if (unmerged_from_ < kHalf) // All pairs are merged long before the free half is full.
    {
        now_[unmerged_from_] = merged(unmerged_from_);
        ++unmerged_from_;
    }
    if (used_ > 0 && in_last_ < stride_)
    {
        now_[used_ - 1].take(frame);
        ++in_last_;
        return;
    }
    if (used_ == kPoints)
    {
        now_.swap(before_);
        unmerged_from_ = 0;
        used_ = kHalf;
        stride_ *= 2;
    }
    now_[used_++] = frame;
    in_last_ = 1;
}

template <typename Point>
std::vector<Point> Series<Point>::points() const
{
    std::vector<Point> all(now_.begin(), now_.begin() + static_cast<std::ptrdiff_t>(used_));
    for (std::size_t pair = unmerged_from_; pair < kPoints / 2; ++pair)
    {
        all[pair] = merged(pair);
    }
    return all;
}

template <typename Point>
Point Series<Point>::merged(std::size_t pair) const noexcept
{
    Point point = before_[2 * pair];
    point.take(before_[2 * pair + 1]);
    return point;
}

template class Series<SeriesPoint>;
template class Series<PathPoint>;

} // namespace tactus::hrtc
