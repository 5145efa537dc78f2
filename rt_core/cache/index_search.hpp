// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/priority.hpp"
#include "rt_core/spm/index_page.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Level of a region; 0 is the highest priority. Each PriorityClass has two, the first for regions
/// at a tool, the second for predicted ones.
[[nodiscard]] constexpr std::uint32_t level_of(PriorityClass of, bool is_present) noexcept
{
    return 2 * static_cast<std::uint32_t>(of) + (is_present ? 0 : 1);
}
[[nodiscard]] constexpr bool is_present(std::uint32_t level) noexcept
{
    return level % 2 == 0;
}
[[nodiscard]] constexpr PriorityClass class_of(std::uint32_t level) noexcept
{
    return static_cast<PriorityClass>(level / 2);
}
inline constexpr std::uint32_t kWantedLevels = 2 * kPriorityClasses;

/// A sphere in which chunks are wanted, in quanta.
struct WantedSphere
{
    QuantumSphere sphere;
    std::uint32_t level{0};
};

/// Spheres in single precision for the kernels, with centres relative to the first sphere's.
class SphereLanes
{
public:
    /// Multiplies each radius by `wider`. `spheres` must not be empty.
    SphereLanes(std::span<const WantedSphere> spheres, double wider) noexcept;

    [[nodiscard]] const KernelSphere* from(std::size_t sphere) const noexcept
    {
        return &lanes_[sphere];
    }
    /// The box of an index page for the kernels, relative to the same point.
    [[nodiscard]] KernelPage page(const QuantumBox& box) const noexcept;

private:
    StaticVector<KernelSphere, kMaxRankedRegions> lanes_;
    std::array<double, 3> around_{};
    double size_{0.0}; ///< Part of a page's slack due to the spheres' size.
};

/// Finds the boxes of a model's index that must be searched so that no chunk that a sphere meets is
/// missed.
///
/// A *round* visits all index pages and lists those that the spheres may come near. On each listed
/// page, eight *groups* of eight boxes have a certificate: the distance by which the spheres may
/// move and grow before one of them can meet a box that it didn't meet when the group was searched.
/// A frame searches the groups whose certificate is used up. The list holds until the spheres have
/// moved farther than the round's margin. A new round begins then, and also kRestFrames after the
/// last one's end, so that all pages in use are touched again.
///
/// A certificate also ends where a sphere of a higher-priority level reaches a box. If a sphere's
/// priority rises, all groups are due. Haptic thread.
class IndexSearch
{
public:
    using Spheres = StaticVector<WantedSphere, kMaxRankedRegions>;
    static constexpr std::uint32_t kGroups = kChunksPerIndexPage / 8;
    static constexpr std::uint32_t kAllGroups = (1U << kGroups) - 1;

    /// A page that the spheres may come near.
    struct NearPage
    {
        IndexPageId page;
        std::uint32_t due{0}; ///< Groups to search in this frame, one bit each.
        /// True if a wider sphere meets the page's box and the index page is resident. Otherwise
        /// `until` holds for the box of the whole page.
        bool is_met{false};
        std::array<float, kGroups> until{}; ///< Motion up to which each group's certificate holds.
    };
    /// Values of NearPage::until: due in the next frame, and never due, as no box matters.
    static constexpr float kNow = -1.0F;
    static constexpr float kNever = 0x1p120F;
    /// Factor that reduces a motion by more than all its roundings, also that to a float.
    static constexpr double kMotionRoundedDown = 1.0 - 0x1p-22;

    /// `frame` is the number before the first frame's.
    explicit IndexSearch(std::uint32_t frame) noexcept
        : round_began_(frame), last_round_began_(frame)
    {
    }

    /// Sets this frame's spheres, the highest priority first; they must stay until the frame's last
    /// search. `pages` are all index pages of the model. Without `keeps_rounds` every frame begins
    /// a round.
    void aim(const Spheres& spheres, std::uint32_t pages, std::uint32_t frame,
             bool keeps_rounds) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::span<const WantedSphere> spheres() const noexcept { return spheres_; }
    /// Factor on the radius of the wider spheres. Resident chunks that a wider sphere meets are
    /// touched; missing ones are requested only if the sphere itself meets them. So chunks that a
    /// sphere has just left stay.
    [[nodiscard]] double wider() const noexcept { return wider_; }
    /// Highest-priority level that the sphere had in this round; its chunks are touched with it. So
    /// a pair in intermittent contact counts as touching.
    [[nodiscard]] std::uint32_t touch_level(std::size_t sphere) const noexcept
    {
        return is_kept_ ? kept_[sphere].level : spheres_[sphere].level;
    }

    /// True if this frame has nothing to search.
    [[nodiscard]] bool is_at_rest() const noexcept { return !is_on_round() && !has_due_; }
    /// The next listed page with groups that are due, each once a frame; null: no more.
    [[nodiscard]] NearPage* next_due() noexcept TACTUS_NONBLOCKING;

    /// True if the round has not ended.
    [[nodiscard]] bool is_on_round() const noexcept { return pages_left_ > 0; }
    /// The round's next page; is_on_round() must hold (asserted).
    [[nodiscard]] IndexPageId next(std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    /// True if a wider sphere may meet the box before the next round.
    [[nodiscard]] bool may_come_to(const QuantumBox& box) const noexcept TACTUS_NONBLOCKING;
    /// Lists a page, all groups of which are due. With a full list every frame begins a round.
    [[nodiscard]] NearPage& add(IndexPageId page) noexcept TACTUS_NONBLOCKING;

    /// Least motion, in quanta, with which a sphere widened by this factor can meet the box; none
    /// if one already meets it.
    [[nodiscard]] std::optional<double> gap_to(const QuantumBox& box,
                                               double wider) const noexcept TACTUS_NONBLOCKING;
    /// Value for NearPage::until of a certificate that holds for a further motion of `gap`.
    [[nodiscard]] float until(double gap) const noexcept
    {
        return static_cast<float>((way_ + gap) * kMotionRoundedDown);
    }

    /// Drops certificates that depend on a page that was loaded or evicted.
    void forget(IndexPageId page) noexcept TACTUS_NONBLOCKING;
    /// Drops certificates that depend on a chunk that was evicted.
    void forget(ChunkId chunk) noexcept TACTUS_NONBLOCKING;
    /// Begins a round in the next frame.
    void begin_again() noexcept { is_kept_ = false; }

    /// Frame before which a page's last touch means that it was unused for two rounds.
    [[nodiscard]] std::uint32_t last_round_began() const noexcept { return last_round_began_; }

    /// Frames from the end of a round to the next one's begin.
    static constexpr std::uint32_t kRestFrames = 16;
    /// Bounds of a round's margin as shares of the smallest sphere's radius; within them it is the
    /// motion of the spheres in kRestFrames at the frame's speed.
    static constexpr double kLeastMargin = 0.1;
    static constexpr double kMostMargin = 1.0;
    /// Factor on the radius of the wider spheres.
    static constexpr double kWider = 1.1;
    /// Largest number of spheres for which a round and its list last longer than a frame: twelve
    /// moving spherical tools. With more, every frame begins a round.
    static constexpr std::size_t kKeptSpheres = 64;
    /// Capacity of the list of near pages.
    static constexpr std::size_t kMaxNear = 32;

private:
    [[nodiscard]] std::optional<double> way_of(const Spheres& spheres) const noexcept;
    void begin_round(const Spheres& spheres, double way, std::uint32_t frame) noexcept;
    void keep(const Spheres& spheres) noexcept;
    void find_due() noexcept;
    [[nodiscard]] NearPage* find(IndexPageId page) noexcept;

    StaticVector<WantedSphere, kKeptSpheres>
        kept_; ///< The last frame's spheres, with touch levels.
    StaticVector<NearPage, kMaxNear> near_;
    NearPage unlisted_;
    QuantumBox region_; ///< Region that no sphere leaves during the round.
    std::span<const WantedSphere> spheres_;
    bool is_kept_{false}; ///< The list and its certificates are valid for the spheres in kept_.
    bool has_due_{false};
    double wider_{1.0};
    double margin_{0.0};
    /// Bound on motion and growth of the spheres since the round began.
    double way_{0.0};
    std::size_t turn_{0};       ///< Next place of the list to check.
    std::size_t turns_left_{0}; ///< Places left to check in this frame.
    std::uint32_t cursor_{0};   ///< Next page of the round.
    std::uint32_t pages_{0};
    std::uint32_t pages_left_{0};    ///< Pages left of the round.
    std::uint32_t ended_{0};         ///< Frame of the round's last page.
    std::uint32_t round_began_;      ///< Frame in which the cursor last passed zero.
    std::uint32_t last_round_began_; ///< Frame in which the cursor passed zero before that.
};

} // namespace tactus
