// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/object_publisher.hpp"

#include "transport/base/printable.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/wire_values.hpp"
#include "transport/model_name.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Number of times each pose is repeated, one every kMotionBeat, since samples may be lost.
constexpr int kRepeats = 3;
/// Interval of motion before the first object: a controller that joins waits for a sample.
constexpr std::chrono::milliseconds kEmptyBeat{100};
/// Time at rest after which an object's record is written again, for controllers that join later.
constexpr auto kRest = std::chrono::milliseconds(500);
/// Least interval of try_renew_motion(), and the longest time until a new writer takes over.
constexpr auto kRenewalEvery = std::chrono::milliseconds(300);
constexpr auto kHandOver = std::chrono::milliseconds(250);
/// Text of a refusal after the name of the object.
constexpr const char* kBadMaterial =
    "has an invalid material: the stiffness must be above 0, friction, damping and viscosity at "
    "least 0, the dynamic friction at most the static friction, and the texture height at most "
    "1/32 of the texture length of 0.0001 to 1 m";

} // namespace

Result<std::unique_ptr<ObjectPublisher>, Refusal>
ObjectPublisher::create(const Domain& domain, std::vector<ContentHash> models)
{
    std::unique_ptr<ObjectPublisher> publisher(new ObjectPublisher(domain, std::move(models)));
    const std::uint64_t epoch = publisher->server_epoch_;
    auto records = make_writer(domain, Topic::objects, server_partition(epoch));
    if (!records)
    {
        return records.error();
    }
    auto motion = make_writer(domain, Topic::motion, server_partition(epoch));
    if (!motion)
    {
        return motion.error();
    }
    publisher->records_ = std::move(records).value();
    publisher->motion_ = std::move(motion).value();
    return publisher;
}

ObjectPublisher::ObjectPublisher(const Domain& domain, std::vector<ContentHash> models)
    : domain_(&domain), server_epoch_(domain.participants().own_epoch()), models_(std::move(models))
{
}

Result<std::uint32_t, Refusal> ObjectPublisher::show(const ShownObject& object)
{
    const auto refuse = [&](const std::string& reason)
    { return Refusal{fmt::format("object '{}' {}", printable(object.name), reason)}; };
    const auto pose = checked_pose(object.pose);
    if (!is_valid_name(object.name))
    {
        return refuse(fmt::format("needs a name of {}", kNameForm));
    }
    if (!pose)
    {
        return refuse(fmt::format("has an invalid pose: {}",
                                  kPoseRefusalNames[static_cast<std::size_t>(pose.error())]));
    }
    if (!is_sound(object.material))
    {
        return refuse(kBadMaterial);
    }
    if (std::ranges::find(models_, object.model) == models_.end())
    {
        return refuse("shows model " + hash_text(object.model) + ", which isn't served");
    }
    if (free_.empty() && slots_.size() == kMaxObjects)
    {
        return refuse(fmt::format("is refused: at most {} objects are served", kMaxObjects));
    }
    if (free_.empty())
    {
        free_.push_back(static_cast<std::uint32_t>(slots_.size()));
        slots_.emplace_back();
    }
    const std::uint32_t number = free_.back();
    free_.pop_back();
    Slot& slot = slots_[number];
    const bool is_listed = slot.is_listed; // Set if the number's previous object is listed.
    slot = {object, slot.generation + 1, true};
    slot.is_listed = is_listed;
    slot.shown.pose = pose.value();
    ++count_;
    write_record(number);
    return number;
}

Result<Done, PoseRefusal> ObjectPublisher::move(std::uint32_t object, const Pose& pose)
{
    TACTUS_ASSERT(find(object) != nullptr);
    const auto checked = checked_pose(pose);
    if (!checked)
    {
        return checked.error();
    }
    Slot& slot = slots_[object];
    slot.shown.pose = checked.value();
    slot.has_moved = slot.owes_record = true;
    slot.repeats = kRepeats;
    slot.moved = Clock::now();
    wake(object);
    return Done{};
}

Result<Done, Refusal> ObjectPublisher::feel(std::uint32_t object, const Material& material)
{
    TACTUS_ASSERT(find(object) != nullptr);
    Slot& slot = slots_[object];
    if (!is_sound(material))
    {
        return Refusal{fmt::format("object '{}' {}", slot.shown.name, kBadMaterial)};
    }
    if (material != slot.shown.material)
    {
        slot.shown.material = material;
        write_record(object);
    }
    return Done{};
}

void ObjectPublisher::remove(std::uint32_t object)
{
    TACTUS_ASSERT(find(object) != nullptr);
    Slot& slot = slots_[object];
    slot.is_shown = slot.has_moved = false;
    slot.repeats = 0;
    --count_;
    write_end(object);
}

void ObjectPublisher::step()
{
    const auto now = Clock::now();
    is_full_ = false;
    change_motion_writer(now);
    due_.clear();
    for (const std::uint32_t object : awake_)
    {
        Slot& slot = slots_[object];
        const bool is_repeat = slot.repeats > 0 && now - slot.sent >= kMotionBeat;
        if (slot.is_shown && (slot.has_moved || is_repeat))
        {
            slot.repeats -= slot.has_moved ? 0 : 1;
            slot.has_moved = false;
            slot.sent = now;
            due_.push_back(object);
        }
    }
    const std::span<const std::uint32_t> due(due_);
    for (std::size_t i = 0; i < due.size(); i += kMaxMoved)
    {
        send(due.subspan(i, std::min<std::size_t>(kMaxMoved, due.size() - i)), now);
    }
    if (due.empty() && now >= next_beat())
    {
        send({}, now);
    }
    settle(now);
}

bool ObjectPublisher::try_renew_motion(Clock::time_point now)
{
    if (now - renewed_ < kRenewalEvery)
    {
        return false;
    }
    auto motion = make_writer(*domain_, Topic::motion, server_partition(server_epoch_));
    if (!motion)
    {
        return false;
    }
    next_motion_ = std::move(motion).value();
    renewed_ = now;
    return true;
}

void ObjectPublisher::change_motion_writer(Clock::time_point now)
{
    if (next_motion_.is_valid() &&
        (readers_of(next_motion_) >= readers_of(motion_) || now - renewed_ >= kHandOver))
    {
        domain_->disposal().dispose(std::make_shared<Endpoint>(std::move(motion_)));
        motion_ = std::exchange(next_motion_, {});
    }
}

ObjectPublisher::Clock::time_point ObjectPublisher::next_beat() const noexcept
{
    return last_sample_ + (slots_.empty() ? kEmptyBeat : kMotionBeat);
}

const ShownObject* ObjectPublisher::find(std::uint32_t object) const noexcept
{
    return object < slots_.size() && slots_[object].is_shown ? &slots_[object].shown : nullptr;
}

void ObjectPublisher::wake(std::uint32_t object)
{
    if (!slots_[object].is_listed)
    {
        slots_[object].is_listed = true;
        awake_.push_back(object);
    }
}

/// Writes the record of an object, or leaves it to a later step if the writer has no room. A failed
/// write waits 5 ms; after one, none is tried in this step, so that a dead controller does not stop
/// all motion.
void ObjectPublisher::write_record(std::uint32_t object)
{
    Slot& slot = slots_[object];
    slot.owes_record = is_full_;
    if (is_full_)
    {
        wake(object);
        return;
    }
    const ShownObject& shown = slot.shown;
    tactus_v5_ObjectRecord record = {};
    record.server_epoch = server_epoch_;
    record.object = object;
    record.generation = slot.generation;
    shown.name.copy(static_cast<char*>(record.name), kMaxNameBytes);
    std::memcpy(record.model_hash, shown.model.data(), shown.model.size());
    put_material(shown.material, record);
    record.serial = ++serial_;
    record.pose = to_wire(shown.pose);
    is_full_ = dds_write(records_.handle, &record) != DDS_RETCODE_OK;
    slot.owes_record = is_full_;
    if (slot.owes_record)
    {
        wake(object);
    }
}

/// Writes the end of an object like write_record(). Its number stays taken until then.
void ObjectPublisher::write_end(std::uint32_t object)
{
    tactus_v5_ObjectRecord record = {};
    record.server_epoch = server_epoch_;
    record.object = object;
    is_full_ = is_full_ || dds_dispose(records_.handle, &record) != DDS_RETCODE_OK;
    slots_[object].owes_record = is_full_;
    if (is_full_)
    {
        wake(object);
        return;
    }
    free_.push_back(object);
}

void ObjectPublisher::settle(Clock::time_point now)
{
    std::erase_if(awake_,
                  [&](std::uint32_t object)
                  {
                      Slot& slot = slots_[object];
                      if (slot.is_shown && now - slot.moved < kRest)
                      {
                          return false;
                      }
                      if (slot.owes_record) // The object is already in awake_.
                      {
                          slot.is_shown ? write_record(object) : write_end(object);
                      }
                      slot.is_listed = slot.owes_record;
                      return !slot.is_listed;
                  });
}

void ObjectPublisher::send(std::span<const std::uint32_t> moved, Clock::time_point now)
{
    std::array<tactus_v5_MovedObject, kMaxMoved> objects{};
    for (std::size_t i = 0; i < moved.size(); ++i)
    {
        const Slot& slot = slots_[moved[i]];
        objects.at(i) = {moved[i], slot.generation, to_wire(slot.shown.pose)};
    }
    tactus_v5_Motion sample = {};
    sample.server_epoch = server_epoch_;
    sample.serial = ++serial_;
    sample.server_time_ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(now.time_since_epoch()).count();
    sample.objects = static_cast<std::uint32_t>(count_);
    const auto count = static_cast<std::uint32_t>(moved.size());
    sample.moved = {count, count, objects.data(), false};
    dds_write(motion_.handle, &sample); // The next sample replaces a failed one.
    last_sample_ = now;
}

} // namespace tactus::dds
