// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/scene_mailbox.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_parts.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/records/material.hpp"

#include <compare>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// Passes a program's changes of the scene to the frame's mailbox: objects that it adds, moves,
/// changes and removes. Any thread but the haptic one calls; the transport thread passes on in
/// step(). Callers may wait for each other and for step(), for some microseconds; the haptic thread
/// never waits. Of several poses or materials between two rounds, the newest is passed on.
class ProgramScene
{
public:
    /// An object, with its generation: a number may be used again for another object.
    struct Key
    {
        std::uint32_t number{0};
        std::uint32_t generation{0};

        auto operator<=>(const Key&) const noexcept = default;
    };

    /// `poses`: those of `parts.objects`, which have generation 0.
    ProgramScene(const SceneParts& parts, std::span<const ObjectPose> poses);

    /// Before the first step(): connects the output, which must live as long as the steps.
    void connect(SceneMailbox& mailbox);

    /// Adds an object; none if all numbers are in use.
    [[nodiscard]] std::optional<Key> try_add(const ObjectSpec& spec, const Similarity& place);
    /// False, without effect, if the object was removed. The material must pass is_sound().
    [[nodiscard]] bool try_move(Key object, const Similarity& place);
    [[nodiscard]] bool try_set_material(Key object, const Material& material);
    [[nodiscard]] bool try_remove(Key object);
    /// Pose that the program gave the object last; none if it was removed.
    [[nodiscard]] std::optional<Similarity> place_of(Key object) const;
    /// Model of the object; none if it was removed.
    [[nodiscard]] std::optional<ModelId> model_of(Key object) const;

    /// Transport thread: passes the changes on until the mailbox's queue is full.
    void step(MonotonicTime now);

private:
    /// One number: what the program wants there, and what the mailbox was told.
    struct Slot
    {
        ObjectSpec spec;
        ObjectPose pose;
        std::uint32_t generation{0}; ///< Generation of the newest object here.
        bool is_resident{false};     ///< True if the program wants an object there.
        bool is_told{false};         ///< True if the mailbox has one.
        std::uint32_t told_generation{0};
        bool owes_material{false};
        bool owes_pose{false};
        bool is_queued{false}; ///< True if the number is in untold_.
    };

    template <typename Change>
    [[nodiscard]] bool try_change(Key object, const Change& change);
    [[nodiscard]] Slot* find(Key object);
    [[nodiscard]] const Slot* find(Key object) const;
    void queue(std::uint32_t number);
    [[nodiscard]] bool try_pass_on(std::uint32_t number, MonotonicTime now);

    mutable std::mutex mutex_; ///< Guards all members but mailbox_.
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> revisions_; ///< Revisions of the models.
    std::deque<std::uint32_t> untold_;     ///< Numbers with changes to pass on.
    SceneMailbox* mailbox_{nullptr};
};

} // namespace tactus::hrtc
