// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/base/spsc_queue.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"
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

/// Use of one object's poses over a run.
struct PoseUse
{
    bool is_followed{false}; ///< True once a pose has arrived; its age counts from then on.
    std::uint64_t moves{0};  ///< Frames whose pose differs from the frame before.
    Duration age_max{};      ///< Longest silence of its host in a frame.
    double step_max_m{0.0};  ///< Largest displacement of the object's origin between two frames.
    std::uint64_t old_frames{0}; ///< Frames in which the silence exceeded the limit.
    /// Frames with a tool near in which its poses exceeded the object speed limit.
    std::uint64_t rate_limited_frames{0};
};

/// Passes the newest pose of each object from the transport thread to the haptic thread, and also
/// added and removed objects and changed materials. Neither thread waits for the other; a pose that
/// is not read in time is overwritten. The haptic thread gets all as changes of the scene.
///
/// An object's motion is blended from its place to its newest pose. That takes the time between
/// that pose and the one before on the host's clock plus most of the time left of the last blend,
/// at most kBlendMax. Contacts therefore see small steps even if poses are early or late. Nothing
/// is extrapolated. After a rest, a pose farther away than kJump_m is taken at once, as it is no
/// motion.
///
/// If a tool touches an object, or may soon, no point of it that the tool may meet exceeds the
/// object speed limit (ObjectSpeedLimit). The object catches up later. A pose taken at once is not
/// limited, even if it exceeds the speed.
///
/// An object's age is the time since its host was last heard, on this machine's clock. An object at
/// rest needs no poses, and costs no changes while its host is heard. Until its first pose an
/// object stays where it was placed, and does not age.
///
/// Objects at rest cost almost nothing: new poses are found by one bit each, and kAgedAFrame
/// objects a frame have their ages checked in turn.
class SceneMailbox
{
public:
    static constexpr Duration kBlendMax = milliseconds(50);
    static constexpr double kJump_m = 0.02;
    /// Number of objects whose age a frame checks; 4,096 objects take 16 frames.
    static constexpr std::size_t kAgedAFrame = 256;
    /// Largest number of added and removed objects and changed materials in the queue.
    static constexpr std::size_t kWaiting = 512;
    /// Largest number of those that a frame takes. Its other changes are moves.
    static constexpr std::size_t kTakenAFrame = kMaxSceneChanges / 2;

    /// `placed`: objects numbered in this order, of generation 0, at their start poses. `objects`:
    /// capacity, 0.8 KiB each. `age_limit`: frames above it are counted; the frame has the same
    /// limit. `speed_max_m_per_s`: speed limit of an object near a tool; above 0.
    SceneMailbox(std::span<const ObjectPose> placed, std::size_t objects, Duration age_limit,
                 double speed_max_m_per_s = kInfinity);
    SceneMailbox(std::span<const ObjectPose> placed, Duration age_limit)
        : SceneMailbox(placed, placed.size(), age_limit)
    {
    }

    /// Transport thread: adds an object under a free number, with a generation above that of its
    /// last object. Its host was heard. False if the queue is full.
    [[nodiscard]] bool try_come(std::size_t object, std::uint32_t generation,
                                const ObjectSpec& spec, const ObjectPose& pose,
                                MonotonicTime arrival) noexcept;
    /// Transport thread: removes the object of that number. False if the queue is full.
    [[nodiscard]] bool try_go(std::size_t object) noexcept;
    /// Transport thread: gives the object another material. False if the queue is full.
    [[nodiscard]] bool try_feel(std::size_t object, const Material& material) noexcept;

    /// Transport thread: passes a pose of an existing object; its host was heard, too. `arrival`:
    /// on the clock of refresh().
    void put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept;
    /// The transport thread: the object's host was heard.
    void hear(std::size_t object, MonotonicTime now) noexcept;

    /// Haptic thread, at the start of a frame: the moves, and the objects whose host fell silent or
    /// was heard again; at most kMaxSceneChanges. More are deferred to the next frame, which begins
    /// with them; up to half of them are for objects near tools, in every frame and in the order of
    /// `touches`. `touches`: result of list_touches() after the last frame, at most kMaxPairs. The
    /// result is valid until the next call. Allocates nothing; 0.1 us an object in motion, 0.6 us
    /// for all at rest.
    [[nodiscard]] std::span<const SceneChange>
    refresh(MonotonicTime now, std::span<const ObjectTouch> touches = {}) noexcept;

    /// Haptic thread: true if this object, near a tool in the last refresh(), was moved above the
    /// object speed limit for longer than ObjectSpeedLimit::kPatience_s.
    [[nodiscard]] bool exceeds_limit(std::size_t object) const noexcept
    {
        return blends_[object].exceeds_limit;
    }
    [[nodiscard]] const ObjectSpeedLimit& belief() const noexcept { return speed_limit_; }

    /// Uses, one an object. Haptic thread, or others once it has ended.
    [[nodiscard]] std::span<const PoseUse> uses() const noexcept { return uses_; }

private:
    /// A pose in plain numbers, since a mailbox needs a trivially copyable type.
    struct PoseSample
    {
        std::array<double, 9> rotation{}; ///< Rotation, row by row.
        std::array<double, 3> translation_m{};
        double scale{1.0};
        std::int64_t stamp_ns{0};
        std::uint32_t revision{0};
        std::int64_t arrival_ns{0};
        std::uint32_t generation{0};
        std::uint64_t number{0}; ///< Number of the pose for this object, from 1.
    };

    /// An object that is added, removed or gets another material, trivially copyable.
    struct SceneEvent
    {
        SceneChangeKind kind{SceneChangeKind::object_goes};
        std::uint32_t object{0};
        PoseSample sample;      ///< Pose of an added object; otherwise only its generation counts.
        std::uint32_t model{0}; ///< Model of an added object.
        Material material;      ///< Material of an added or changed object.
    };

    /// Motion of one object.
    struct Blend
    {
        Similarity from;
        Similarity to;
        MonotonicTime start;
        /// Time of the last place given to the frame, or of the start of the motion.
        MonotonicTime moved;
        Duration time{}; ///< Duration of the blend; 0: `to` is taken at once.
        bool is_resident{false};
        bool is_under_way{false};
        /// True if the frame has been given the time its host was last heard.
        bool is_told_old{false};
        bool is_near{false};       ///< True if a tool touches it or may soon; during refresh().
        bool is_held{false};       ///< True if the object lags its blend, since a tool is near.
        bool exceeds_limit{false}; ///< Result of exceeds_limit().
    };

    [[nodiscard]] PoseSample letter_of(std::size_t object, const ObjectPose& pose,
                                       MonotonicTime arrival) noexcept;
    [[nodiscard]] static ObjectPose pose_of(const PoseSample& sample) noexcept;
    [[nodiscard]] std::size_t take_scene_events() noexcept;
    void take_samples(MonotonicTime now) noexcept;
    void look_at_ages(MonotonicTime now) noexcept;
    [[nodiscard]] bool try_move(std::size_t object, MonotonicTime now,
                                SceneChange& change) noexcept;
    void begin_blend(std::size_t object, const PoseSample& sample, MonotonicTime now) noexcept;
    void move_on(std::size_t object, MonotonicTime now) noexcept;
    [[nodiscard]] double way_near_m(std::size_t object, const Similarity& to) const noexcept;
    [[nodiscard]] static Similarity place_at(const Blend& blend, MonotonicTime now) noexcept;
    [[nodiscard]] Duration age_of(std::size_t object, MonotonicTime now) const noexcept;
    /// True at half the limit, so that the frame reaches the limit at the right time.
    [[nodiscard]] bool is_silent(Duration age) const noexcept { return age.ns > age_limit_.ns / 2; }
    void move_to(std::size_t object, const Similarity& place) noexcept;

    Duration age_limit_;
    ObjectSpeedLimit speed_limit_;
    std::span<const ObjectTouch> touches_; ///< Touches during refresh().
    std::vector<Similarity> places_;       ///< Places as the frame has them.
    std::vector<PoseSample> samples_;      ///< Last sample read, one an object.
    std::vector<Blend> blends_;
    std::vector<PoseUse> uses_;
    std::vector<std::uint64_t> unread_; ///< One bit an object: an unread sample.
    std::vector<std::uint64_t> awake_;  ///< One bit an object: the frame may need a change of it.
    MonotonicTime last_refresh_{};
    std::size_t first_{0};     ///< Object whose turn is first in the next frame.
    std::size_t next_aged_{0}; ///< Object whose age is checked first.
    std::array<SceneChange, kMaxSceneChanges> changes_{};
    std::vector<std::uint64_t> numbers_;     ///< Last pose put; the transport thread's.
    std::vector<std::uint32_t> generations_; ///< Generation of the object; the transport thread's.
    std::vector<SceneEvent> scene_event_slots_;
    SpscQueue<SceneEvent> scene_events_;
    // NOLINTBEGIN(*-avoid-c-arrays): they don't move.
    std::unique_ptr<Mailbox<PoseSample>[]> mailboxes_;
    std::unique_ptr<std::atomic<std::int64_t>[]> heard_ns_; ///< Relaxed: it orders nothing else.
    /// One bit an object: a pose was put since.
    std::unique_ptr<std::atomic<std::uint64_t>[]> came_;
    // NOLINTEND(*-avoid-c-arrays)
};

} // namespace tactus
