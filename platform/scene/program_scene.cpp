// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/program_scene.hpp"

#include "rt_core/spm/header.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Time at which a program's object was last heard: never too long ago, since a program that moves
/// nothing is not a silent server.
constexpr MonotonicTime kAlways{std::numeric_limits<std::int64_t>::max()};

} // namespace

ProgramScene::ProgramScene(const SceneParts& parts, std::span<const ObjectPose> poses)
    : slots_(parts.objects_max)
{
    for (const ServedModel& model : parts.models)
    {
        revisions_.push_back(ModelHeader::parse(model.header).value().fields().revision);
    }
    for (std::size_t i = 0; i < parts.objects.size(); ++i)
    {
        Slot& slot = slots_[i];
        slot.spec = parts.objects[i];
        slot.pose = poses[i];
        slot.is_resident = true;
        slot.is_told = true;
    }
}

void ProgramScene::connect(SceneMailbox& mailbox)
{
    mailbox_ = &mailbox;
}

std::optional<ProgramScene::Key> ProgramScene::try_add(const ObjectSpec& spec,
                                                       const Similarity& place)
{
    const std::lock_guard lock(mutex_);
    const auto free = std::ranges::find(slots_, false, &Slot::is_resident);
    if (free == slots_.end())
    {
        return std::nullopt;
    }
    const auto number = static_cast<std::uint32_t>(free - slots_.begin());
    free->spec = spec;
    free->pose = ObjectPose{place};
    free->pose.revision = revisions_[spec.model.value];
    free->is_resident = true;
    ++free->generation;
    queue(number);
    return Key{number, free->generation};
}

/// Changes the slot of an object that the program has not removed. False if there is none.
template <typename Change>
bool ProgramScene::try_change(Key object, const Change& change)
{
    const std::lock_guard lock(mutex_);
    Slot* const slot = find(object);
    if (slot != nullptr)
    {
        change(*slot);
        queue(object.number);
    }
    return slot != nullptr;
}

bool ProgramScene::try_move(Key object, const Similarity& place)
{
    return try_change(object,
                      [&](Slot& slot)
                      {
                          static_cast<Similarity&>(slot.pose) = place;
                          slot.owes_pose = true;
                      });
}

bool ProgramScene::try_set_material(Key object, const Material& material)
{
    return try_change(object,
                      [&](Slot& slot)
                      {
                          slot.spec.material = material;
                          slot.owes_material = true;
                      });
}

bool ProgramScene::try_remove(Key object)
{
    return try_change(object, [](Slot& slot) { slot.is_resident = false; });
}

std::optional<Similarity> ProgramScene::place_of(Key object) const
{
    const std::lock_guard lock(mutex_);
    const Slot* const slot = find(object);
    return slot != nullptr ? std::optional<Similarity>(slot->pose) : std::nullopt;
}

std::optional<ModelId> ProgramScene::model_of(Key object) const
{
    const std::lock_guard lock(mutex_);
    const Slot* const slot = find(object);
    return slot != nullptr ? std::optional(slot->spec.model) : std::nullopt;
}

void ProgramScene::step(MonotonicTime now)
{
    const std::lock_guard lock(mutex_);
    while (!untold_.empty() && try_pass_on(untold_.front(), now))
    {
        slots_[untold_.front()].is_queued = false;
        untold_.pop_front();
    }
}

/// Slot of an object that the program has not removed; null otherwise.
ProgramScene::Slot* ProgramScene::find(Key object)
{
    return const_cast<Slot*>(std::as_const(*this).find(object));
}

const ProgramScene::Slot* ProgramScene::find(Key object) const
{
    const bool is_known = object.number < slots_.size() && slots_[object.number].is_resident &&
                          slots_[object.number].generation == object.generation;
    return is_known ? &slots_[object.number] : nullptr;
}

void ProgramScene::queue(std::uint32_t number)
{
    if (!std::exchange(slots_[number].is_queued, true))
    {
        untold_.push_back(number);
    }
}

/// Tells the mailbox all changes of one number. False if its queue is full; the rest is passed on
/// by a later call.
bool ProgramScene::try_pass_on(std::uint32_t number, MonotonicTime now)
{
    Slot& slot = slots_[number];
    if (slot.is_told && (!slot.is_resident || slot.told_generation != slot.generation))
    {
        if (!mailbox_->try_remove(number))
        {
            return false;
        }
        slot.is_told = false;
    }
    if (!slot.is_resident)
    {
        return true;
    }
    if (!slot.is_told)
    {
        if (!mailbox_->try_add(number, slot.generation, slot.spec, slot.pose, now))
        {
            return false;
        }
        slot.is_told = true;
        slot.told_generation = slot.generation;
        slot.owes_material = false; // An added object has its newest material and pose.
        slot.owes_pose = false;
        mailbox_->note_heard(number, kAlways);
    }
    if (slot.owes_material)
    {
        if (!mailbox_->try_set_material(number, slot.spec.material))
        {
            return false;
        }
        slot.owes_material = false;
    }
    if (slot.owes_pose)
    {
        mailbox_->put(number, slot.pose, now);
        mailbox_->note_heard(number, kAlways);
        slot.owes_pose = false;
    }
    return true;
}

} // namespace tactus::hrtc
