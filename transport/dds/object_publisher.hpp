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

/// Interval at which a server with objects sends motion, an empty sample if nothing moves. Poses
/// are stale after 100 ms of silence, so four samples in a row may be lost.
inline constexpr std::chrono::milliseconds kMotionBeat{20};

/// Publishes objects to controllers and adds, moves and removes them. Owned and stepped by
/// DdsServer. One thread. move() never waits. The other calls wait up to 5 ms, once a step, if
/// controllers do not take the written records.
class ObjectPublisher
{
public:
    /// `domain` must outlive the publisher. `models` are the hashes of the models that the server
    /// serves.
    [[nodiscard]] static Result<std::unique_ptr<ObjectPublisher>, Refusal>
    create(const Domain& domain, std::vector<ContentHash> models);

    /// Adds an object and returns its number for move(), feel(), remove() and telemetry. Refused,
    /// with nothing changed, for an invalid name, material or pose, a model that is not served, or
    /// more than kMaxObjects.
    [[nodiscard]] Result<std::uint32_t, Refusal> show(const ShownObject& object);
    /// Sets the pose, sent by the next step(). Refused, with nothing changed, if the pose is
    /// invalid. The object must exist (asserted), also in feel() and remove().
    [[nodiscard]] Result<Done, PoseRefusal> move(std::uint32_t object, const Pose& pose);
    /// Sets the material. Refused, with nothing changed, if the material is invalid. May wait like
    /// show().
    [[nodiscard]] Result<Done, Refusal> feel(std::uint32_t object, const Material& material);
    /// Removes an object. Its number is free once the removal is written to the controllers.
    void remove(std::uint32_t object);

    /// Sends all motion, or an empty sample as a sign that the server is present. Call it after
    /// moves and at least every kMotionBeat. Takes 0.1 us or less if nothing moves.
    void step();

    /// Replaces the writer of motion. Both writers exist until the new one has as many readers, or
    /// for 250 ms, so that no controller misses a sample. False within 300 ms of the last
    /// replacement, or if no writer can be created.
    bool try_renew_motion(std::chrono::steady_clock::time_point now);

    /// Time at which step() has work even if nothing moves.
    [[nodiscard]] std::chrono::steady_clock::time_point next_beat() const noexcept;

    [[nodiscard]] std::size_t objects() const noexcept { return count_; }
    /// The object of that number; null if there is none.
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
        bool owes_record{false}; ///< True if the record, or the end, must still be written.
        int repeats{0};          ///< Number of times its pose is still to be repeated.
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
    std::uint64_t server_epoch_;
    std::vector<ContentHash> models_;
    Endpoint records_;
    Endpoint motion_;
    Endpoint next_motion_; ///< Writer that will replace `motion_`; empty if none will.
    Clock::time_point renewed_{};
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;  ///< Free numbers below slots_.size().
    std::vector<std::uint32_t> awake_; ///< Numbers of objects that moved recently or owe a record.
    std::vector<std::uint32_t> due_;
    std::size_t count_{0};
    std::uint64_t serial_{0};
    Clock::time_point last_sample_{};
    bool is_full_{false}; ///< True if the writer of records had no room since the last step().
};

} // namespace tactus::dds
