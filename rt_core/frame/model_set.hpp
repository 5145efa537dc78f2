// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
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

/// A frame's models, their outputs, and which of them it looks at: those that a pair is of, and as
/// long after as there is something left to do for them. Haptic thread.
class ModelSet
{
public:
    /// Room for so many.
    ModelSet(Arena& arena, std::size_t most) noexcept
        : slots_(arena.take<ModelSlot>(most)), outputs_(arena.take<ModelOutput>(most))
    {
    }

    /// Where the next model is made; add() follows. Without memory, that is while it is measured,
    /// there is none.
    [[nodiscard]] std::optional<Model>& next() noexcept { return slots_[count_].model; }
    /// What next() made is there from now on, and busy.
    void add(std::uint32_t frame) noexcept;
    [[nodiscard]] std::uint32_t size() const noexcept { return count_; }

    [[nodiscard]] Model& operator[](ModelId id) noexcept { return *slots_[id.value].model; }
    [[nodiscard]] const Model& operator[](ModelId id) const noexcept
    {
        return *slots_[id.value].model;
    }
    [[nodiscard]] ModelSlot& slot(ModelId id) noexcept { return slots_[id.value]; }
    [[nodiscard]] const ModelSlot& slot(ModelId id) const noexcept { return slots_[id.value]; }

    /// By their numbers.
    [[nodiscard]] std::span<const ModelId> busy() const noexcept { return busy_.view(); }
    /// Each is first in its turn: what the first one leaves of the frame's budgets is for the next.
    [[nodiscard]] ModelId in_turn(std::uint32_t busy, std::uint32_t frame) const noexcept
    {
        return busy_[(frame + busy) % busy_.size()];
    }
    /// It is looked at, whether a pair is of it or not.
    void keep_busy(ModelId id) noexcept TACTUS_NONBLOCKING;
    /// A pair is of it in this frame.
    void wake(ModelId id, std::uint32_t frame) noexcept TACTUS_NONBLOCKING;
    /// The frame ends: those that no pair was of in it, and that have nothing left to do, rest.
    void let_rest(std::uint32_t frame) noexcept TACTUS_NONBLOCKING;

    /// Fits the trees of busy models to the faces that changed, or `all` of them.
    void refit(bool all, WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// The frame ends: takes the state of busy models into outputs().
    void report() noexcept TACTUS_NONBLOCKING;
    /// One for each that there is room for.
    [[nodiscard]] std::span<const ModelOutput> outputs() const noexcept { return outputs_; }

private:
    std::span<ModelSlot> slots_;
    std::span<ModelOutput> outputs_;
    std::uint32_t count_{0};
    StaticVector<ModelId, kMaxModels> busy_;
};

} // namespace tactus
