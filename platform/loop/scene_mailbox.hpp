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
#include <span>
#include <vector>

namespace tactus
{

/// Use of one object's poses over a run.
struct PoseUse
{
    bool is_followed{false}; ///< True once a pose has arrived; the age counts from then on.
    std::uint64_t moves{0};  ///< Frames whose pose differs from the frame before.
    Duration age_max{};      ///< Longest time since the server was last heard, over all frames.
    double step_max_m{0.0};  ///< Largest displacement of the object's origin between two frames.
    std::uint64_t old_frames{0}; ///< Frames with an age above the age limit.
    /// Frames in which a tool was near and the server's poses exceeded the object speed limit.
    std::uint64_t rate_limited_frames{0};
};

/// Passes changes of the scene from the transport thread to the haptic thread: the newest pose of
/// each object, added and removed objects, and changed materials. Neither thread waits for the
/// other; a pose that is not read in time is overwritten.
///
/// An object moves from its present place to its newest pose in a blend. The blend lasts as long as
/// the server's time between the last two poses, plus four fifths of the last blend's remaining
/// time, at most kBlendMax. Contacts therefore see small steps even if poses are early or late.
/// Nothing is extrapolated. If the last two poses are more than kBlendMax apart in time and the new
/// one is farther away than kJump_m, the object takes it at once.
///
/// If a tool touches an object or may touch it soon, the blend is limited: no point of the object
/// that the tool may meet exceeds the object speed limit (ObjectSpeedLimit). The object catches up
/// later. A pose taken at once is limited only if the object can catch up within
/// ObjectSpeedLimit::kPatience_s.
///
/// An object's age is the time since its server was last heard, on this machine's clock. An object
/// at rest needs no poses, and costs no changes while its server is heard. Until its first pose an
/// object stays where it was placed, and does not age.
///
/// Objects at rest cost almost nothing: one bit an object marks a new pose, and a frame checks the
/// ages of kAgedAFrame objects in turn.
class SceneMailbox
{
public:
    static constexpr Duration kBlendMax = milliseconds(50);
    static constexpr double kJump_m = 0.02;
    /// Number of objects whose age a frame checks; 4,096 objects take 16 frames.
    static constexpr std::size_t kAgedAFrame = 256;
    /// Capacity of the queue of added and removed objects and changed materials.
    static constexpr std::size_t kWaiting = 512;
    /// Largest number of queue entries that a frame takes. The frame's other changes are moves.
    static constexpr std::size_t kTakenAFrame = kMaxSceneChanges / 2;

    /// `placed`: start poses of the objects of generation 0, numbered in this order. `objects`:
    /// capacity, 0.8 KiB each. `age_limit`: must equal the frame's own limit; PoseUse counts frames
    /// above it. `speed_max_m_per_s`: speed limit of an object near a tool; above 0.
    SceneMailbox(std::span<const ObjectPose> placed, std::size_t objects, Duration age_limit,
                 double speed_max_m_per_s = kInfinity);
    SceneMailbox(std::span<const ObjectPose> placed, Duration age_limit)
        : SceneMailbox(placed, placed.size(), age_limit)
    {
    }

    /// Transport thread: queues a new object under a free number. `generation` must exceed that of
    /// the number's last object. Also calls note_heard(). False if the queue is full.
    [[nodiscard]] bool try_add(std::size_t object, std::uint32_t generation, const ObjectSpec& spec,
                               const ObjectPose& pose, MonotonicTime arrival) noexcept;
    /// Transport thread: queues the removal of the object of that number. False if the queue is
    /// full.
    [[nodiscard]] bool try_remove(std::size_t object) noexcept;
    /// Transport thread: queues another material for the object. False if the queue is full.
    [[nodiscard]] bool try_set_material(std::size_t object, const Material& material) noexcept;

    /// Transport thread: passes a pose of an existing object, and calls note_heard(). `arrival`: on
    /// the clock of refresh().
    void put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept;
    /// Transport thread: notes that the object's server was heard at `now`.
    void note_heard(std::size_t object, MonotonicTime now) noexcept;

    /// Haptic thread, at the start of a frame: returns the changes of the scene, at most
    /// kMaxSceneChanges, valid until the next call. They also tell the frame which objects' servers
    /// fell silent or were heard again. Changes without room wait for the next frame, which begins
    /// with them. Objects near tools come first in every frame, in the order of `touches`, with at
    /// most half of the changes. `touches`: result of list_touches() after the last frame, at most
    /// kMaxPairs. Allocates nothing; 0.1 us an object in motion, 0.6 us for all at rest.
    [[nodiscard]] std::span<const SceneChange>
    refresh(MonotonicTime now, std::span<const ObjectTouch> touches = {}) noexcept;

    /// Haptic thread: true if this object, near a tool in the last refresh(), lags its server's
    /// pose by more than the object speed limit allows in ObjectSpeedLimit::kPatience_s.
    [[nodiscard]] bool exceeds_limit(std::size_t object) const noexcept
    {
        return blends_[object].exceeds_limit;
    }
    [[nodiscard]] const ObjectSpeedLimit& belief() const noexcept { return speed_limit_; }

    /// Uses of poses, one an object. Haptic thread, or any other once the haptic one has ended.
    [[nodiscard]] std::span<const PoseUse> uses() const noexcept { return uses_; }

private:
    /// Pose in plain numbers, since a mailbox needs a trivially copyable type.
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

    /// Queue entry: an object is added, removed or gets another material. Trivially copyable.
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
        /// Time of the last place given to the frame, or of the refresh() before the motion.
        MonotonicTime moved;
        Duration time{}; ///< Duration of the blend; 0: `to` is taken at once.
        bool is_resident{false};
        bool is_under_way{false};
        /// True if the object's last change told the frame that its server is silent.
        bool is_told_old{false};
        bool is_near{false}; ///< True during refresh() if `touches` has the object.
        /// True if the object speed limit holds the object behind its blend.
        bool is_held{false};
        bool exceeds_limit{false}; ///< Result of exceeds_limit().
    };

    [[nodiscard]] PoseSample sample_of(std::size_t object, const ObjectPose& pose,
                                       MonotonicTime arrival) noexcept;
    [[nodiscard]] static ObjectPose pose_of(const PoseSample& sample) noexcept;
    [[nodiscard]] std::size_t take_scene_events() noexcept;
    void take_samples(MonotonicTime now) noexcept;
    void check_ages(MonotonicTime now) noexcept;
    [[nodiscard]] bool try_move(std::size_t object, MonotonicTime now,
                                SceneChange& change) noexcept;
    void begin_blend(std::size_t object, const PoseSample& sample, MonotonicTime now) noexcept;
    void move_on(std::size_t object, MonotonicTime now) noexcept;
    [[nodiscard]] double way_near_m(std::size_t object, const Similarity& to) const noexcept;
    [[nodiscard]] static Similarity place_at(const Blend& blend, MonotonicTime now) noexcept;
    [[nodiscard]] Duration age_of(std::size_t object, MonotonicTime now) const noexcept;
    /// True above half the age limit. The frame then has the time when the server was last heard
    /// before the age limit passes.
    [[nodiscard]] bool is_silent(Duration age) const noexcept { return age.ns > age_limit_.ns / 2; }
    void move_to(std::size_t object, const Similarity& place) noexcept;

    Duration age_limit_;
    ObjectSpeedLimit speed_limit_;
    std::span<const ObjectTouch> touches_; ///< `touches` of refresh(), valid while it runs.
    std::vector<Similarity> places_;       ///< Places of the objects in the frame.
    std::vector<PoseSample> samples_;      ///< Last sample read, one an object.
    std::vector<Blend> blends_;
    std::vector<PoseUse> uses_;
    /// One bit an object: set if its mailbox has an unread sample.
    std::vector<std::uint64_t> unread_;
    /// One bit an object: set if the frame may need a change of it.
    std::vector<std::uint64_t> awake_;
    MonotonicTime last_refresh_{};
    std::size_t first_{0};     ///< Object whose move comes first in the next frame.
    std::size_t next_aged_{0}; ///< Object whose age the next frame checks first.
    std::array<SceneChange, kMaxSceneChanges> changes_{};
    /// Number of each object's last pose; transport thread only.
    std::vector<std::uint64_t> numbers_;
    std::vector<std::uint32_t> generations_; ///< Generation of each object; transport thread only.
    std::vector<SceneEvent> scene_event_slots_;
    SpscQueue<SceneEvent> scene_events_;
    // NOLINTBEGIN(*-avoid-c-arrays): they don't move.
    std::unique_ptr<Mailbox<PoseSample>[]> mailboxes_;
    std::unique_ptr<std::atomic<std::int64_t>[]> heard_ns_; ///< Relaxed: it orders nothing else.
    /// One bit an object: put() sets it, take_samples() clears it.
    std::unique_ptr<std::atomic<std::uint64_t>[]> came_;
    // NOLINTEND(*-avoid-c-arrays)
};

} // namespace tactus
