// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/model_set.hpp"
#include "rt_core/frame/pair.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Lets guests come and go: models of which a frame starts with the header alone.
///
///     known -> wanted -> arriving -> resident -> leaving -> known
///
/// One that is wanted and whose base mesh doesn't come is known again: the transport thread gives
/// its room back. While a pair is of it it is wanted again after a while.
///
/// A guest is wanted as soon as a pair is of it, which is as far ahead as the hand comes in 150 ms
/// or as kGuestLead_m. Room for its base mesh is kept then, the mesh is asked for, and its faces
/// enter in slices, those of the most urgent pair first. Until it is resident its pairs answer from
/// its box. It leaves when no pair has been of it for 2 s, or before that where one that is wanted
/// has no room: then the one that was left longest ago, or else, of those whose pairs can spare
/// them, that of the least urgent one, if that is twice as far from a touch. Haptic thread.
class ModelLife
{
public:
    explicit ModelLife(std::int64_t period_ns) noexcept;

    /// One frame, after what has arrived was adopted; `pairs` by urgency. A pair sees what comes of
    /// it in the next frame.
    void go_on(ModelSet& models, std::span<Pair* const> pairs, std::uint32_t frame,
               WorkCounters& work) noexcept TACTUS_NONBLOCKING;

private:
    /// One frame of one model.
    struct Turn
    {
        std::uint32_t entering{0};  ///< Faces that may still go in in this frame,
        std::uint32_t leaving{0};   ///< and out.
        const Pair* waits{nullptr}; ///< The most urgent one whose model has no room; may be none.
        /// A model gave its room back, which the one that waits finds in the next frame; before
        /// that no other one has to go.
        bool gave_room{false};
    };
    static void want(ModelSet& models, const Pair& pair, std::uint32_t frame, Turn& turn) noexcept;
    static void go_on(Model& model, Turn& turn, std::uint32_t frame, WorkCounters& work) noexcept;
    void let_go(ModelSet& models, std::uint32_t frame) const noexcept;
    static void make_room(ModelSet& models, std::span<Pair* const> pairs, const Pair& waits,
                          std::uint32_t frame) noexcept;
    [[nodiscard]] static std::optional<ModelId> find_left(const ModelSet& models,
                                                          std::uint32_t frame) noexcept;
    [[nodiscard]] static std::optional<ModelId>
    find_spare(const ModelSet& models, std::span<Pair* const> pairs, const Pair& waits) noexcept;

    std::uint32_t linger_frames_{0};
};

} // namespace tactus
