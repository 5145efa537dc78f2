// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// What the loop did with one object's poses over a run.
struct PoseUse
{
    bool is_followed{false};     ///< A pose has come: from then on its age counts.
    std::uint64_t moves{0};      ///< Frames that began with another pose than the one before.
    Duration age_max{};          ///< Oldest pose that a frame used.
    double step_max_m{0.0};      ///< Farthest that the object's origin went between two frames.
    std::uint64_t old_frames{0}; ///< Frames with a pose older than the limit.
};

/// Carries the newest pose of each object from the transport thread to the haptic thread. Neither
/// waits for the other, and what nobody looked at in time is overwritten.
///
/// A pose's age is the time since it arrived, on this machine's clock: no clock of the host's is
/// asked. So an object whose poses stop coming grows old. Until its first pose an object stands
/// where it was placed, and never grows old. Between two poses it stands still: nothing is guessed.
class PoseDoor
{
public:
    /// At most kMaxObjects objects, where they stand at the start. `age_limit`: older ones are
    /// counted; the frame has the same limit.
    PoseDoor(std::span<const ObjectPose> placed, Duration age_limit);

    /// The transport thread. `arrival`: on the clock that refresh() is told.
    void put(std::size_t object, const ObjectPose& pose, MonotonicTime arrival) noexcept;

    /// The haptic thread, at the start of a frame: the newest poses, aged. Allocates nothing;
    /// 0.02 us an object.
    void refresh(MonotonicTime now) noexcept;

    /// The haptic thread: as refresh() left them.
    [[nodiscard]] std::span<const ObjectPose> poses() const noexcept { return poses_; }

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
        std::uint64_t number{0}; ///< From 1, of this object.
    };

    [[nodiscard]] static ObjectPose pose_of(const Letter& letter) noexcept;
    void move_to(std::size_t object, const ObjectPose& pose) noexcept;
    void age(std::size_t object, MonotonicTime now) noexcept;

    Duration age_limit_;
    std::vector<ObjectPose> poses_;
    std::vector<Letter> letters_; ///< The last that was read, one an object.
    std::vector<PoseUse> uses_;
    std::array<std::uint64_t, kMaxObjects> numbers_{}; ///< Last put; the transport thread's.
    std::array<Mailbox<Letter>, kMaxObjects> mailboxes_;
};

} // namespace tactus
