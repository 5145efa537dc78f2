// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/model_id.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/limits.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Models of a frame, their outputs, and a list of the busy ones, which frames update. A model is
/// busy while it has a pair, and afterwards until nothing is left to do for it. Haptic thread.
/// Cost: linear in the busy models, and for a refit in the marked blocks and the nodes above them.
class ModelSet
{
public:
    /// Reserves memory for `most` models.
    ModelSet(Arena& arena, std::size_t most) noexcept
        : slots_(arena.take<ModelSlot>(most)), outputs_(arena.take<ModelOutput>(most))
    {
    }

    /// Place in which to make the next model; add() follows. Invalid if the arena only measures.
    [[nodiscard]] std::optional<Model>& next() noexcept { return slots_[count_].model; }
    /// Adds the model made in next(), as busy.
    void add(std::uint32_t frame) noexcept;
    [[nodiscard]] std::uint32_t size() const noexcept { return count_; }

    [[nodiscard]] Model& operator[](ModelId id) noexcept { return *slots_[id.value].model; }
    [[nodiscard]] const Model& operator[](ModelId id) const noexcept
    {
        return *slots_[id.value].model;
    }
    [[nodiscard]] ModelSlot& slot(ModelId id) noexcept { return slots_[id.value]; }
    [[nodiscard]] const ModelSlot& slot(ModelId id) const noexcept { return slots_[id.value]; }

    /// Busy models in the order of their ids.
    [[nodiscard]] std::span<const ModelId> busy() const noexcept { return busy_.view(); }
    /// Busy model at a position that rotates with the frame: each model comes first in turn, and
    /// later ones get the rest of the frame's budgets.
    [[nodiscard]] ModelId in_turn(std::uint32_t busy, std::uint32_t frame) const noexcept
    {
        TACTUS_ASSERT(busy < busy_.size());
        return busy_[(frame + busy) % busy_.size()];
    }
    /// Keeps the model busy even without a pair.
    void keep_busy(ModelId id) noexcept TACTUS_NONBLOCKING;
    /// Marks the model as having a pair in this frame.
    void wake(ModelId id, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    /// Ends the frame: models without a pair in it and with nothing left to do are no longer busy.
    void let_rest(std::uint32_t frame) noexcept TACTUS_NONBLOCKING;

    /// Refits the trees of busy models to the changed faces, or, with `all`, to all faces.
    void refit(bool all, WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// Copies the state of busy models into outputs() at the end of the frame.
    void report() noexcept TACTUS_NONBLOCKING;
    /// Outputs of all models; those of models that are not busy are of their last busy frame.
    [[nodiscard]] std::span<const ModelOutput> outputs() const noexcept { return outputs_; }

private:
    std::span<ModelSlot> slots_;
    std::span<ModelOutput> outputs_;
    std::uint32_t count_{0};
    StaticVector<ModelId, kMaxModels> busy_;
};

} // namespace tactus
