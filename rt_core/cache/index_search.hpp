// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/urgency.hpp"
#include "rt_core/spm/index_page.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// 0 is the most urgent: two for each UrgencyClass, a tool that is there and one that is predicted.
[[nodiscard]] constexpr std::uint32_t level_of(UrgencyClass of, bool is_present) noexcept
{
    return 2 * static_cast<std::uint32_t>(of) + (is_present ? 0 : 1);
}
[[nodiscard]] constexpr bool is_present(std::uint32_t level) noexcept
{
    return level % 2 == 0;
}
[[nodiscard]] constexpr UrgencyClass class_of(std::uint32_t level) noexcept
{
    return static_cast<UrgencyClass>(level / 2);
}
inline constexpr std::uint32_t kWantedLevels = 2 * kUrgencyClasses;

/// A ball in which chunks are wanted, in quanta.
struct WantedBall
{
    QuantumBall ball;
    std::uint32_t level{0};
};

/// Balls as the kernels see them, around the first one's centre.
class BallLanes
{
public:
    /// Each ball's radius is so many times its own.
    BallLanes(std::span<const WantedBall> balls, double wider) noexcept;

    [[nodiscard]] const KernelBall* from(std::size_t ball) const noexcept { return &lanes_[ball]; }
    /// An index page with this box, around the same point.
    [[nodiscard]] KernelPage page(const QuantumBox& box) const noexcept;

private:
    StaticVector<KernelBall, kMaxRankedRegions> lanes_;
    std::array<double, 3> around_{};
    double size_{0.0}; ///< What the balls add to a page's slack.
};

/// Which boxes of a model's index are to be looked at, so that no chunk that a ball meets is
/// missed.
///
/// A *round* goes over all index pages and lists those that the balls may come near. Of each page
/// on the list eight *groups* of eight boxes have a certificate: so far the balls may move and grow
/// before one of them can meet a box that it didn't when the group was looked at. A frame looks at
/// the groups whose certificate is used up. The list holds until the balls have gone farther than
/// the round's margin; a round begins then, and kRestFrames after the last one's end, by which all
/// that is of use is touched again.
///
/// Where a ball of a more urgent level comes to a box counts, too, and where a ball becomes more
/// urgent all groups are due. Haptic thread.
class IndexSearch
{
public:
    using Balls = StaticVector<WantedBall, kMaxRankedRegions>;
    static constexpr std::uint32_t kGroups = kChunksPerIndexPage / 8;
    static constexpr std::uint32_t kAllGroups = (1U << kGroups) - 1;

    /// A page that the balls may come near.
    struct NearPage
    {
        IndexPageId page;
        std::uint32_t due{0}; ///< The groups to look at in this frame, a bit each.
        /// A wider ball meets its box; until then the certificates are of that box.
        bool is_met{false};
        std::array<float, kGroups> until{}; ///< So far on the balls' way each group's holds.
    };
    /// A group that has to be looked at in the next frame, and one without a box that matters.
    static constexpr float kNow = -1.0F;
    static constexpr float kNever = 0x1p120F;

    /// `frame` is the one before the first.
    explicit IndexSearch(std::uint32_t frame) noexcept
        : round_began_(frame), last_round_began_(frame)
    {
    }

    /// This frame's balls, the most urgent first; they must stay until the frame's last look.
    /// `pages` are all index pages of the model. Without `keeps_rounds` every frame begins a round.
    void aim(const Balls& balls, std::uint32_t pages, std::uint32_t frame,
             bool keeps_rounds) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::span<const WantedBall> balls() const noexcept { return balls_; }
    /// What balls a little wider meet is of use, and as urgent as if they met it; only what they
    /// meet as they are is asked for. So what a ball has just left stays, and what it will meet
    /// next has the urgency of where it is. So many times their radius.
    [[nodiscard]] double wider() const noexcept { return wider_; }
    /// The most urgent level of a ball in this round, as which it touches what it meets: a pair
    /// that touches now and then is one that touches.
    [[nodiscard]] std::uint32_t touch_level(std::size_t ball) const noexcept
    {
        return is_kept_ ? kept_[ball].level : balls_[ball].level;
    }

    /// Whether nothing is to be looked at in this frame.
    [[nodiscard]] bool is_at_rest() const noexcept { return !is_on_round() && !has_due_; }
    /// The next page of the list with groups that are due, each once a frame; null: no more.
    [[nodiscard]] NearPage* next_due() noexcept TACTUS_NONBLOCKING;

    /// Whether the round has not come to its end.
    [[nodiscard]] bool is_on_round() const noexcept { return pages_left_ > 0; }
    /// The round's next page; on a round.
    [[nodiscard]] IndexPageId next(std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    /// Whether a wider ball may meet the box before the next round.
    [[nodiscard]] bool may_come_to(const QuantumBox& box) const noexcept TACTUS_NONBLOCKING;
    /// Lists a page, all groups of which are due. Where the list is full every frame begins a
    /// round.
    [[nodiscard]] NearPage& add(IndexPageId page) noexcept TACTUS_NONBLOCKING;

    /// How far the balls may move before one, so many times wider, can meet the box; none when one
    /// does.
    [[nodiscard]] std::optional<double> gap_to(const QuantumBox& box,
                                               double wider) const noexcept TACTUS_NONBLOCKING;
    /// The end of a certificate that holds for so much motion from now on.
    [[nodiscard]] float until(double gap) const noexcept
    {
        // Less by more than all roundings of ways.
        return static_cast<float>((way_ + gap) * (1.0 - 0x1p-22));
    }

    /// What the page's certificates rest on has changed: it came or went.
    void forget(IndexPageId page) noexcept TACTUS_NONBLOCKING;
    /// The chunk has gone.
    void forget(ChunkId chunk) noexcept TACTUS_NONBLOCKING;
    /// The next frame begins a round.
    void begin_again() noexcept { is_kept_ = false; }

    /// A page that was of use at least once in two rounds was touched in this frame or later.
    [[nodiscard]] std::uint32_t last_round_began() const noexcept { return last_round_began_; }

    /// Between two rounds: pages stay touched all but as soon as without a rest.
    static constexpr std::uint32_t kRestFrames = 16;
    /// A round's margin is what the balls go in a rest at the frame's speed, within these shares of
    /// the smallest one's radius.
    static constexpr double kLeastMargin = 0.1;
    static constexpr double kMostMargin = 1.0;
    /// How much wider balls are.
    static constexpr double kWider = 1.1;
    /// Balls that a round is kept for: twelve spheres that move. With more every frame begins one.
    static constexpr std::size_t kKeptBalls = 64;
    /// Pages on the list.
    static constexpr std::size_t kMaxNear = 32;

private:
    [[nodiscard]] std::optional<double> way_of(const Balls& balls) const noexcept;
    void begin_round(const Balls& balls, double way, std::uint32_t frame) noexcept;
    void keep(const Balls& balls) noexcept;
    void find_due() noexcept;
    [[nodiscard]] NearPage* find(IndexPageId page) noexcept;

    StaticVector<WantedBall, kKeptBalls> kept_; ///< The last frame's balls, with touch levels.
    StaticVector<NearPage, kMaxNear> near_;
    NearPage unlisted_;
    QuantumBox region_; ///< No ball leaves it during the round.
    std::span<const WantedBall> balls_;
    bool is_kept_{false}; ///< The list and its certificates are of kept_.
    bool has_due_{false};
    double wider_{1.0};
    double margin_{0.0};
    double way_{0.0};           ///< How far any ball moved and grew at most since the round began.
    std::size_t turn_{0};       ///< Next place of the list to look at,
    std::size_t turns_left_{0}; ///< and how many of them in this frame.
    std::uint32_t cursor_{0};   ///< Next page to look at.
    std::uint32_t pages_{0};
    std::uint32_t pages_left_{0};    ///< Of the round.
    std::uint32_t ended_{0};         ///< Frame of its last page.
    std::uint32_t round_began_;      ///< Frame in which the cursor last passed zero,
    std::uint32_t last_round_began_; ///< and the time before.
};

} // namespace tactus
