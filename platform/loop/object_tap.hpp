// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/telemetry.hpp"

#include <atomic>
#include <cstdint>
#include <span>

namespace tactus::hrtc
{

/// Copy of the poses of objects at the end of one frame, with the controller's numbers.
struct ObjectsCopy
{
    struct Object
    {
        std::uint32_t number{0};
        std::uint32_t model{0};
        Similarity pose; ///< Pose of the model's frame.
    };

    std::uint32_t sweep_begin{0}; ///< Range as in ObjectsTelemetry.
    std::uint32_t sweep_end{0};
    StaticVector<Object, kMaxShownObjects> objects;
};

/// Copies the poses of objects for viewers. The copy belongs to one thread at a time: the haptic
/// thread fills it; the transport thread reads it and gives it back. Neither ever waits.
class ObjectTap
{
public:
    /// Haptic thread, after a frame: makes a copy if the last one was given back. Allocates
    /// nothing; about 0.1 us, and 10 ns for each object of the copy.
    void show(const ObjectTable& objects, std::span<const PairOutput> pairs) noexcept
    {
        if (!is_out_.load(std::memory_order_acquire)) // Pairs with the release in give_back().
        {
            copy(objects, pairs);
            is_out_.store(true, std::memory_order_release); // Pairs with the acquire in take().
        }
    }

    /// Transport thread: the copy, valid until give_back(); null if there is none.
    [[nodiscard]] const ObjectsCopy* take() const noexcept
    {
        // Pairs with the release in show().
        return is_out_.load(std::memory_order_acquire) ? &copy_ : nullptr;
    }
    /// Transport thread, only after take() returned a copy. If the copy `was_sent`, the next one
    /// has the following range of numbers, else the same range again.
    void give_back(bool was_sent) noexcept
    {
        was_sent_ = was_sent;
        is_out_.store(false, std::memory_order_release); // Pairs with the acquire in show().
    }

private:
    void copy(const ObjectTable& objects, std::span<const PairOutput> pairs) noexcept;
    void add(const ObjectTable& objects, std::uint32_t number) noexcept;

    std::atomic<bool> is_out_{false};
    bool was_sent_{false}; ///< Belongs to the owner of the copy.
    ObjectsCopy copy_;
};

} // namespace tactus::hrtc
