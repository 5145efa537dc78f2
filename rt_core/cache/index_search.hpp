// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/urgency.hpp"
#include "rt_core/spm/index_page.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// A ball in which chunks are wanted, in quanta.
struct WantedBall
{
    QuantumBall ball;
    /// 0 is the most urgent: two for each UrgencyClass, a tool that is there and one foretold to
    /// be.
    std::uint32_t level{0};

    [[nodiscard]] bool is_present() const noexcept { return level % 2 == 0; }
    [[nodiscard]] UrgencyClass of() const noexcept { return static_cast<UrgencyClass>(level / 2); }
};

[[nodiscard]] constexpr std::uint32_t level_of(UrgencyClass of, bool is_present) noexcept
{
    return 2 * static_cast<std::uint32_t>(of) + (is_present ? 0 : 1);
}
inline constexpr std::uint32_t kWantedLevels = 2 * kUrgencyClasses;

[[nodiscard]] bool meets(const QuantumBall& ball,
                         const QuantumBox& box) noexcept TACTUS_NONBLOCKING;

/// The model's chunks that some balls need, found by going round and round over its index pages.
///
/// A round is for balls a little wider than they are. While the balls stay within them, and the
/// round found all that they meet on its way or here, the next one waits kRestFrames. What only the
/// wider balls meet is looked at alone meanwhile. Haptic thread.
class IndexSearch
{
public:
    using Balls = StaticVector<WantedBall, kMaxRankedRegions>;

    /// `frame` is the one before the first.
    explicit IndexSearch(std::uint32_t frame) noexcept
        : round_began_(frame), last_round_began_(frame)
    {
    }

    /// This frame's balls, the most urgent first; they must stay until the frame's last next().
    /// `pages` are all index pages of the model. Without `keeps_rounds` every frame begins a round.
    void aim(const Balls& balls, std::uint32_t pages, std::uint32_t frame,
             bool keeps_rounds) noexcept TACTUS_NONBLOCKING;

    /// Whether the round has come to its end: nothing is to be looked at in this frame.
    [[nodiscard]] bool is_at_rest() const noexcept { return pages_left_ == 0; }
    /// The round's next page; not at rest.
    [[nodiscard]] IndexPageId next(std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    /// What the round is for, the most urgent first.
    [[nodiscard]] std::span<const WantedBall> balls() const noexcept { return balls_; }
    /// This frame's balls, each within that of the round.
    [[nodiscard]] std::span<const WantedBall> aimed_at() const noexcept { return aimed_at_; }

    /// Not all that was found is on its way, or a page has come that was not searched: the next
    /// frame begins a round.
    void begin_anew() noexcept { is_kept_ = false; }

    /// A chunk that is not here, and that no ball of the frame met when the round came to it.
    struct Beside
    {
        ChunkId chunk;
        QuantumBox box;
    };
    /// Until the next round; there is one at once when there are too many.
    void add_beside(const Beside& beside) noexcept
    {
        is_kept_ = beside_.try_push_back(beside) && is_kept_;
    }
    /// One of them that a ball of this frame meets now, and the most urgent of those balls; none
    /// when there is no more. It is no longer beside.
    struct Met
    {
        ChunkId chunk;
        WantedBall ball;
    };
    [[nodiscard]] std::optional<Met> take_met() noexcept TACTUS_NONBLOCKING;

    /// A page that was of use at least once in two rounds was touched in this frame or later.
    [[nodiscard]] std::uint32_t last_round_began() const noexcept { return last_round_began_; }

    /// Between two rounds: pages stay touched, and a lost wish is asked for again, all but as soon
    /// as without a rest.
    static constexpr std::uint32_t kRestFrames = 16;
    /// How much wider balls are searched for, as a share of their radius.
    static constexpr double kMargin = 0.1;
    /// Balls that a round is kept for: twelve spheres that move. With more every frame begins one.
    static constexpr std::size_t kKeptBalls = 64;
    /// Chunks beside, of which each model keeps room for twice as many: a slide of a mesh looks at
    /// 3,161 pages with so many, at 4,036 with 8, and at 8,810 without.
    static constexpr std::size_t kMaxBeside = 12;

private:
    [[nodiscard]] bool holds(const Balls& balls) const noexcept;

    StaticVector<WantedBall, kKeptBalls> kept_;
    StaticVector<Beside, kMaxBeside> beside_;
    std::span<const WantedBall> balls_;
    std::span<const WantedBall> aimed_at_;
    bool is_kept_{false};
    std::uint32_t cursor_{0}; ///< Next page to look at.
    std::uint32_t pages_{0};
    std::uint32_t pages_left_{0};    ///< Of the round.
    std::uint32_t ended_{0};         ///< Frame of its last page.
    std::uint32_t round_began_;      ///< Frame in which the cursor last passed zero,
    std::uint32_t last_round_began_; ///< and the time before.
};

} // namespace tactus
