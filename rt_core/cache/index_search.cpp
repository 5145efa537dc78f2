// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/index_search.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

bool holds(const WantedBall& outer, const WantedBall& inner) noexcept
{
    const double room = outer.ball.radius - inner.ball.radius;
    double moved_sq = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double way = outer.ball.center[axis] - inner.ball.center[axis];
        moved_sq += way * way;
    }
    return outer.level == inner.level && room >= 0.0 && moved_sq <= room * room;
}

} // namespace

bool meets(const QuantumBall& ball, const QuantumBox& box) noexcept
{
    double distance_sq = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double gap = std::max({static_cast<double>(box.low[axis]) - ball.center[axis],
                                     ball.center[axis] - static_cast<double>(box.high[axis]), 0.0});
        distance_sq += gap * gap;
    }
    return distance_sq <= ball.radius * ball.radius;
}

void IndexSearch::aim(const Balls& balls, std::uint32_t pages, std::uint32_t frame,
                      bool keeps_rounds) noexcept
{
    pages_ = pages;
    aimed_at_ = balls.view();
    if (balls.empty())
    {
        // Nothing is of use here: whatever was touched before is not.
        is_kept_ = false;
        beside_.clear();
        balls_ = {};
        pages_left_ = 0;
        round_began_ = frame;
        last_round_began_ = frame;
        return;
    }
    if (keeps_rounds && is_kept_ && holds(balls) &&
        (pages_left_ > 0 || frame - ended_ <= kRestFrames))
    {
        return;
    }
    is_kept_ = keeps_rounds && balls.size() <= kKeptBalls;
    balls_ = balls.view();
    beside_.clear();
    pages_left_ = pages;
    ended_ = frame;
    if (is_kept_)
    {
        kept_.clear();
        for (const WantedBall& ball : balls)
        {
            kept_.push_back(ball);
            kept_[kept_.size() - 1].ball.radius *= 1.0 + kMargin;
        }
        balls_ = kept_.view();
    }
}

bool IndexSearch::holds(const Balls& balls) const noexcept
{
    return std::ranges::equal(kept_, balls,
                              [](const WantedBall& outer, const WantedBall& inner)
                              { return tactus::holds(outer, inner); });
}

std::optional<IndexSearch::Met> IndexSearch::take_met() noexcept
{
    for (Beside& beside : beside_)
    {
        const auto met = std::ranges::find_if(aimed_at_, [&beside](const WantedBall& aimed)
                                              { return meets(aimed.ball, beside.box); });
        if (met != aimed_at_.end())
        {
            const ChunkId chunk = beside.chunk;
            beside = beside_[beside_.size() - 1];
            beside_.pop_back();
            return Met{chunk, *met};
        }
    }
    return std::nullopt;
}

IndexPageId IndexSearch::next(std::uint32_t frame) noexcept
{
    TACTUS_ASSERT(!is_at_rest());
    const IndexPageId page{cursor_};
    TACTUS_ASSERT(page.value < pages_);
    cursor_ = cursor_ + 1 >= pages_ ? 0 : cursor_ + 1;
    if (cursor_ == 0)
    {
        last_round_began_ = round_began_;
        round_began_ = frame;
    }
    --pages_left_;
    ended_ = frame;
    return page;
}

} // namespace tactus
