// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/model_id.hpp"
#include "rt_core/base/realtime.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

class ModelSet;
class Pair;
struct Model;
struct WorkCounters;

/// Loads and removes streamed models, which start with the header alone.
///
///     known -> wanted -> arriving -> resident -> leaving -> known
///
/// If the base mesh of a wanted model doesn't arrive, the transport thread returns its memory and
/// the model is known again. While it has a pair, it is wanted again after a while.
///
/// A model is wanted once it has a pair: at a distance that the device moves in 150 ms, or
/// kStreamedHorizon_m. Memory for its base mesh is reserved, the mesh is requested, and its faces
/// enter in slices, by the priority of their pairs. Until it is resident its pairs answer from its
/// box.
///
/// A model leaves after 2 s without a pair. If memory for a wanted model is missing, the model
/// without a pair for longest leaves at once. If all have pairs, that of the lowest-priority pair
/// leaves, if its pairs can spare it and it is twice as far from contact. Haptic thread. Cost:
/// linear in the pairs and the models, and in the faces that enter or leave in the frame.
class ModelLife
{
public:
    explicit ModelLife(std::int64_t period_ns) noexcept;

    /// Does one frame's work, after arrivals were adopted; `pairs` are sorted by priority. Pairs
    /// see the changes in the next frame.
    void advance(ModelSet& models, std::span<Pair* const> pairs, std::uint32_t frame,
                 WorkCounters& work) noexcept TACTUS_NONBLOCKING;

private:
    /// Progress of one frame of advance().
    struct Turn
    {
        std::uint32_t entering{0}; ///< Faces that may still enter in this frame.
        std::uint32_t leaving{0};  ///< Faces that may still leave in this frame.
        /// Pair of highest priority whose model lacks memory; null if none.
        const Pair* waits{nullptr};
        /// True if a model has returned its memory, which the waiting pair gets in the next frame.
        /// No other model has to leave before that.
        bool gave_room{false};
    };
    static void want(ModelSet& models, const Pair& pair, std::uint32_t frame, Turn& turn) noexcept;
    static void advance(Model& model, Turn& turn, std::uint32_t frame, WorkCounters& work) noexcept;
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
