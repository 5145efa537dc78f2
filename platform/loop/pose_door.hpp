// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/geometry/believed_motion.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/object_touch.hpp"
#include "rt_core/records/scene_change.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus
{

/// What the loop did with one object's poses over a run.
struct PoseUse
{
    bool is_followed{false};     ///< A pose has come: from then on its age counts.
    std::uint64_t moves{0};      ///< Frames that began with another pose than the one before.
    Duration age_max{};          ///< Longest silence of its host that a frame met.
    double step_max_m{0.0};      ///< Farthest that the object's origin went between two frames.
    std::uint64_t old_frames{0}; ///< Frames in which that was longer than the limit.
    /// Frames in which a tool was near and its poses moved it faster than is believed.
    std::uint64_t outran_frames{0};
};

/// Carries the newest pose of each object from the transport thread to the haptic thread, and which
/// objects come, go and feel otherwise. Neither thread waits for the other; a pose that nobody
/// looked at in time is overwritten. The haptic thread gets them as changes of the scene.
///
/// An object glides: from where it is to its newest pose, over the time that lies between that pose
/// and the one before on the host's clock, and most of what was left of the way before, at most
/// kGlideMax. So what touches it feels many small steps and not a few large ones, also when poses
/// come early or late. Nothing is extrapolated: it never goes where its host didn't put
/// it. After a rest a pose that is farther than kJump_m is taken at once: that is no motion.
///
/// Where a tool touches it, or may soon, an object is carried no faster than is believed
/// (BelievedSpeed): no point of it that the tool may meet goes faster. It
/// catches up when it may. What is taken at once isn't held back if it outruns its belief.
///
/// An object's age is the time since its host was last heard, on this machine's clock. One that
/// rests needs no poses, and costs no changes while its host is heard. Until its first pose an
/// object stands where it was placed, and never grows old.
///
/// What rests costs a frame next to nothing: poses that came are found by a bit each, and ages are
/// looked at by kAgedAFrame objects in turn.
class PoseDoor
{
public:
    static constexpr Duration kGlideMax = milliseconds(50);
    static constexpr double kJump_m = 0.02;
    /// Objects whose age a frame looks at: 4,096 have their turn within 16 frames.
    static constexpr std::size_t kAgedAFrame = 256;
    /// Comings, goings and other materials that may wait for their frame.
    static constexpr std::size_t kWaiting = 512;
    /// How many of those a frame takes at most. The other changes of a frame are for moves.
    static constexpr std::size_t kTakenAFrame = kMaxSceneChanges / 2;

    /// Objects by their numbers, of generation 0, where they stand at the start, and room for
    /// `objects` in all: 0.8 KiB each. `age_limit`: older ones are counted; the frame has the same
    /// limit. `speed_max_m_per_s`: believed of an object that a tool may touch; above 0.
    PoseDoor(std::span<const ObjectPose> placed, std::size_t objects, Duration age_limit,
             double speed_max_m_per_s = kInfinity);
    PoseDoor(std::span<const ObjectPose> placed, Duration age_limit)
        : PoseDoor(placed, placed.size(), age_limit)
    {
    }

    /// The transport thread: an object comes under a number that no other has, of a generation that
    /// is higher than that of the one before. Its host was heard. False when too many wait.
    [[nodiscard]] bool try_come(std::size_t object, std::uint32_t generation,
                                const ObjectSpec& spec, const ObjectPose& pose,
                                MonotonicTime arrival) noexcept;
    /// The transport thread: the object that came there last goes. False when too many wait.
    [[nodiscard]] bool try_go(std::size_t object) noexcept;
    /// The transport thread: that object has another material. False when too many wait.
    [[nodiscard]] bool try_feel(std::size_t object, const Material& material) noexcept;

    /// The transport thread; the object is there and its host was heard, too. `arrival`: on the
    /// clock that refresh() is told.
    void put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept;
    /// The transport thread: the object's host was heard.
    void hear(std::size_t object, MonotonicTime now) noexcept;

    /// The haptic thread, at the start of a frame: what moves, and objects whose host fell silent
    /// or was heard again; at most kMaxSceneChanges. More wait for the next frame, which begins
    /// with them; up to half of the room is for what tools may touch, in every frame and in its
    /// order. `touches`: as the last frame left the tools (list_touches()), at most kMaxPairs.
    /// Valid until the next call. Allocates nothing; 0.1 us an object that glides, 0.6 us for all
    /// that rest.
    [[nodiscard]] std::span<const SceneChange>
    refresh(MonotonicTime now, std::span<const ObjectTouch> touches = {}) noexcept;

    /// The haptic thread: whether in the last refresh() this object, which a tool may touch, was
    /// moved faster than is believed for longer than BelievedSpeed::kPatience_s.
    [[nodiscard]] bool outruns(std::size_t object) const noexcept
    {
        return glides_[object].outruns;
    }
    [[nodiscard]] const BelievedSpeed& belief() const noexcept { return belief_; }

    /// One an object. The haptic thread, or others once it has ended.
    [[nodiscard]] std::span<const PoseUse> uses() const noexcept { return uses_; }

private:
    /// A pose in plain numbers: what passes a mailbox must be trivially copyable.
    struct Letter
    {
        std::array<double, 9> rotation{}; ///< Row by row.
        std::array<double, 3> translation_m{};
        double scale{1.0};
        std::int64_t stamp_ns{0};
        std::uint32_t revision{0};
        std::int64_t arrival_ns{0};
        std::uint32_t generation{0}; ///< Of the object.
        std::uint64_t number{0};     ///< From 1, of this object.
    };

    /// An object that comes, goes or feels otherwise, likewise.
    struct Passage
    {
        SceneChangeKind kind{SceneChangeKind::object_goes};
        std::uint32_t object{0};
        Letter letter;          ///< Where it comes; else only its generation counts.
        std::uint32_t model{0}; ///< When it comes.
        Material material;      ///< When it comes or feels.
    };

    /// One object, and its way.
    struct Glide
    {
        Similarity from;
        Similarity to;
        MonotonicTime start;
        MonotonicTime moved; ///< When the frame was last told where it is, or it began to move.
        Duration time{};     ///< 0: it is at once where it goes.
        bool is_here{false};
        bool is_under_way{false};
        bool is_told_old{false}; ///< The frame knows when its host was last heard.
        bool is_near{false};     ///< A tool touches it or may soon, during refresh().
        bool is_held{false};     ///< Behind where it would be, since a tool is near.
        bool outruns{false};     ///< As outruns() tells.
    };

    [[nodiscard]] Letter letter_of(std::size_t object, const ObjectPose& pose,
                                   MonotonicTime arrival) noexcept;
    [[nodiscard]] static ObjectPose pose_of(const Letter& letter) noexcept;
    [[nodiscard]] std::size_t take_passages() noexcept;
    void take_letters(MonotonicTime now) noexcept;
    void look_at_ages(MonotonicTime now) noexcept;
    [[nodiscard]] bool try_move(std::size_t object, MonotonicTime now,
                                SceneChange& change) noexcept;
    void begin_glide(std::size_t object, const Letter& letter, MonotonicTime now) noexcept;
    void move_on(std::size_t object, MonotonicTime now) noexcept;
    [[nodiscard]] double way_near_m(std::size_t object, const Similarity& to) const noexcept;
    [[nodiscard]] static Similarity place_at(const Glide& glide, MonotonicTime now) noexcept;
    [[nodiscard]] Duration age_of(std::size_t object, MonotonicTime now) const noexcept;
    /// Before the limit, so that the frame meets it at the right time.
    [[nodiscard]] bool is_silent(Duration age) const noexcept { return age.ns > age_limit_.ns / 2; }
    void move_to(std::size_t object, const Similarity& place) noexcept;

    Duration age_limit_;
    BelievedSpeed belief_;
    std::span<const ObjectTouch> touches_; ///< During refresh().
    std::vector<Similarity> places_;       ///< As the frame has them.
    std::vector<Letter> letters_;          ///< The last that was read, one an object.
    std::vector<Glide> glides_;
    std::vector<PoseUse> uses_;
    std::vector<std::uint64_t> unread_; ///< A bit an object: its letter was not read yet.
    std::vector<std::uint64_t> awake_;  ///< Likewise: the frame may have to be told of it.
    MonotonicTime last_refresh_{};
    std::size_t first_{0};     ///< Whose turn it is first in the next frame.
    std::size_t next_aged_{0}; ///< Whose age is looked at first.
    std::array<SceneChange, kMaxSceneChanges> changes_{};
    std::vector<std::uint64_t> numbers_;     ///< Last put; the transport thread's,
    std::vector<std::uint32_t> generations_; ///< and the object's.
    std::vector<Passage> passage_slots_;
    SpscQueue<Passage> passages_;
    // NOLINTBEGIN(*-avoid-c-arrays): they don't move.
    std::unique_ptr<Mailbox<Letter>[]> mailboxes_;
    std::unique_ptr<std::atomic<std::int64_t>[]> heard_ns_; ///< Without order to anything else.
    std::unique_ptr<std::atomic<std::uint64_t>[]> came_;    ///< A bit an object: put since.
    // NOLINTEND(*-avoid-c-arrays)
};

} // namespace tactus
