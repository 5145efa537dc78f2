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

/// Interval at which a server with objects sends motion, whether they move or not. Controllers take
/// poses for stale after 100 ms of silence, so four lost samples in a row do no harm.
inline constexpr std::chrono::milliseconds kMotionBeat{20};

/// Shows objects to controllers while a program runs: objects are added, moved and removed. DdsHost
/// has one, and steps it. One thread. move() never waits; the other calls may, for 5 ms and once a
/// step, if controllers do not take what was written.
class ObjectPublisher
{
public:
    /// `domain` must outlive the publisher; `models` are the hashes that the server has.
    [[nodiscard]] static Result<std::unique_ptr<ObjectPublisher>, Refusal>
    create(const Domain& domain, std::vector<ContentHash> models);

    /// Adds an object. Returns its number for move(), feel(), remove() and telemetry. Refused, with
    /// nothing shown: a bad name, material or pose, a model that the server lacks, or kMaxObjects
    /// reached.
    [[nodiscard]] Result<std::uint32_t, Refusal> show(const ShownObject& object);
    /// Sets the pose from the next step() on. Refused, with nothing changed, if the numbers are not
    /// a pose. The object must exist (asserted), also for the calls below.
    [[nodiscard]] Result<Done, PoseRefusal> move(std::uint32_t object, const Pose& pose);
    /// Sets the material. Refused, with nothing changed, if the numbers are not a material. May
    /// wait like show() if controllers have not taken earlier samples.
    [[nodiscard]] Result<Done, Refusal> feel(std::uint32_t object, const Material& material);
    /// Removes an object. Its number is reused only after controllers were notified.
    void remove(std::uint32_t object);

    /// Sends all motion, in one sample if it fits, and the sign that the server is present. Call it
    /// after moving, and at least every kMotionBeat. 0.1 us or less if nothing moves.
    void step();

    /// Replaces the writer of motion. The new one takes over once it has as many readers, or after
    /// 250 ms; until then both exist, so no controller misses a sample. Three times a second at
    /// most; false if it is not due.
    bool try_renew_motion(std::chrono::steady_clock::time_point now);

    /// Time when step() has work though nothing moves.
    [[nodiscard]] std::chrono::steady_clock::time_point next_beat() const noexcept;

    [[nodiscard]] std::size_t objects() const noexcept { return count_; }
    /// Null if there is no object of that number.
    [[nodiscard]] const ShownObject* find(std::uint32_t object) const noexcept;

private:
    using Clock = std::chrono::steady_clock;
    struct Slot
    {
        ShownObject shown;
        std::uint32_t generation{0};
        bool is_shown{false};
        bool is_listed{false};   ///< True if the object is in awake_.
        bool has_moved{false};   ///< True if the object moved since the last sample.
        bool owes_record{false}; ///< True if the last record written is outdated.
        int repeats{0};          ///< Repetitions of its pose, in case samples are lost.
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
    Endpoint next_motion_; ///< Writer that replaces `motion_`.
    Clock::time_point renewed_{};
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;  ///< Free numbers that were used before.
    std::vector<std::uint32_t> awake_; ///< Numbers of the objects that are not at rest.
    std::vector<std::uint32_t> due_;
    std::size_t count_{0};
    std::uint64_t serial_{0};
    Clock::time_point last_sample_{};
    bool is_full_{false}; ///< The writer of records had no room since the last step.
};

} // namespace tactus::dds
