// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/topics.hpp"
#include "transport/pose.hpp"
#include "transport/shown_object.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tactus::dds
{

/// A host with objects is heard this often, whether they move or not: controllers take poses for
/// stale after 100 ms of silence, four lost samples in a row do no harm.
inline constexpr std::chrono::milliseconds kMotionBeat{20};

/// Shows objects to controllers while a program runs: they come, move and go. DdsHost has one, and
/// steps it. One thread. move() never waits; the others may, for 5 ms and once a step, where
/// controllers don't take what was written.
class ObjectPublisher
{
public:
    /// `domain` must outlive it; `models` are those that the host serves.
    [[nodiscard]] static Result<std::unique_ptr<ObjectPublisher>, Refusal>
    create(const Domain& domain, std::vector<ContentHash> models);

    /// The object is there from now on; its number, by which it is moved, pushed and removed. In
    /// telemetry it has the same. Refused, with nothing shown: a bad name, material or pose, a
    /// model that isn't served, or kMaxObjects are there.
    [[nodiscard]] Result<std::uint32_t, Refusal> show(const ShownObject& object);
    /// It stands there from the next step() on. Refused, with nothing changed, when the numbers
    /// aren't a pose. There must be such an object (asserted), as for remove().
    [[nodiscard]] Result<Done, PoseRefusal> move(std::uint32_t object, const Pose& pose);
    /// It feels so from now on. Refused, with nothing changed, when the numbers aren't a material.
    /// May wait as show(), where nobody took what was said before.
    [[nodiscard]] Result<Done, Refusal> feel(std::uint32_t object, const Material& material);
    /// It is gone; another one may get its number, once controllers were told.
    void remove(std::uint32_t object);

    /// Sends what has moved, all in one sample where it fits, and says that the host is there.
    /// Call it after moving, and every kMotionBeat at least. 0.1 us and less where all rests.
    void step();

    /// Another writer takes the place of the one that tells what moves, as soon as it is heard by
    /// as many, or after 250 ms: until then both are there, so no controller misses one. Three
    /// times a second at most; false when it is not due.
    bool try_renew_motion(std::chrono::steady_clock::time_point now);

    /// When step() has something to do though nothing moves; far off when nothing was ever shown.
    [[nodiscard]] std::chrono::steady_clock::time_point next_beat() const noexcept;

    [[nodiscard]] std::size_t objects() const noexcept { return count_; }
    /// Null where there is none of that number.
    [[nodiscard]] const ShownObject* find(std::uint32_t object) const noexcept;

private:
    using Clock = std::chrono::steady_clock;
    struct Slot
    {
        ShownObject shown;
        std::uint32_t generation{0};
        bool is_shown{false};
        bool is_listed{false};   ///< In awake_.
        bool has_moved{false};   ///< Since it was sent.
        bool owes_record{false}; ///< What was written last isn't how it stands.
        int repeats{0};          ///< Of its pose, in case that samples get lost.
        Clock::time_point moved{};
        Clock::time_point sent{};
    };

    ObjectPublisher(const Domain& domain, std::vector<ContentHash> models);

    void change_motion_writer(Clock::time_point now);
    void wake(std::uint32_t object);
    void write_record(std::uint32_t object);
    void write_end(std::uint32_t object);
    void settle(Clock::time_point now);
    void send(std::span<const std::uint32_t> moved, Clock::time_point now);

    const Domain* domain_;
    std::uint64_t host_epoch_;
    std::vector<ContentHash> models_;
    Endpoint records_;
    Endpoint motion_;
    Endpoint next_motion_; ///< Takes its place.
    Clock::time_point renewed_{};
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;  ///< Numbers that were used.
    std::vector<std::uint32_t> awake_; ///< Numbers of those that don't rest.
    std::vector<std::uint32_t> due_;
    std::size_t count_{0};
    std::uint64_t serial_{0};
    Clock::time_point last_sample_{};
    bool is_full_{false}; ///< The writer of records had no room since the last step.
};

} // namespace tactus::dds
