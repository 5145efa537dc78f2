// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/scene_keeper.hpp"

#include "platform/scene/material_limits.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::hrtc
{

SceneKeeper::SceneKeeper(std::span<const dds::Authority> authorities,
                         std::unique_ptr<dds::SceneReader> reader, SceneParts parts,
                         ShownScene scene, Log log)
    : authorities_(authorities)
    , reader_(std::move(reader))
    , parts_(std::move(parts))
    , scene_(std::move(scene.name))
    , materials_(std::move(scene.materials))
    , log_(std::move(log))
    , model_servers_(parts_.models.size())
    , first_(parts_.first_objects)
    , slots_(parts_.objects_max)
    , counts_(parts_.models.size())
    , heard_(parts_.models.size())
{
    for (const ServedModel& model : parts_.models)
    {
        headers_.push_back(ModelHeader::parse(model.header).value());
    }
    if (!scene_.empty())
    {
        servers_.assign(1, scene.server_epoch);
    }
    for (std::uint32_t place = 0; place < slots_.size(); ++place)
    {
        Slot& slot = slots_[place];
        if (place >= parts_.objects.size())
        {
            free_.insert(place);
            continue;
        }
        slot.spec = parts_.objects[place];
        slot.is_resident = true;
        slot.is_told = true;
        if (!scene_.empty())
        {
            slot.bound = scene.objects[place];
            places_[scene.objects[place]] = place;
        }
    }
}

void SceneKeeper::connect(SceneMailbox& mailbox, MonotonicTime now, NameSink names)
{
    mailbox_ = &mailbox;
    names_ = std::move(names);
    for (const auto& [name, place] : places_) // Objects added since are added in the first step.
    {
        const auto& objects = reader_->objects(name.server_epoch);
        if (const auto object = objects.find(name.number); object != objects.end())
        {
            move(place, object->second, now);
            change_material(place, object->second.shown);
        }
    }
}

void SceneKeeper::step(MonotonicTime now)
{
    if (scene_.empty())
    {
        follow_model_servers(now);
    }
    else
    {
        follow_scene_server();
    }
    reader_->poll(servers_, [&](dds::SceneNews news, const dds::SeenObject& object)
                  { take_news(news, object, now); });
    pass_on(now);
    offer_left_out(now);
    note_heard(now);
}

std::optional<ServerObject> SceneKeeper::shown_as(std::uint32_t object) const
{
    return object < slots_.size() ? slots_[object].bound : std::nullopt;
}

/// If another server has the authority now, removes our objects, so that its objects can be added.
void SceneKeeper::follow_scene_server()
{
    const std::uint64_t epoch = authorities_.front().server();
    if (servers_.front() == epoch)
    {
        return;
    }
    while (!places_.empty())
    {
        remove_object(places_.begin()->second);
    }
    passed_over_.clear();
    left_out_.clear();
    limited_.clear();
    servers_.assign(1, epoch);
}

void SceneKeeper::follow_model_servers(MonotonicTime now)
{
    servers_.clear();
    for (std::size_t i = 0; i < model_servers_.size(); ++i)
    {
        const std::uint64_t epoch = authorities_[i].server();
        if (model_servers_[i] != epoch)
        {
            model_servers_[i] = epoch;
            find_first(i, now);
        }
        if (std::ranges::find(servers_, epoch) == servers_.end())
        {
            servers_.push_back(epoch);
        }
    }
}

void SceneKeeper::take_news(dds::SceneNews news, const dds::SeenObject& object, MonotonicTime now)
{
    const ServerObject name{object.server_epoch, object.number};
    const auto bound = places_.find(name);
    if (news == dds::SceneNews::moves && bound != places_.end())
    {
        move(bound->second, object, now);
        return;
    }
    if (news == dds::SceneNews::feels)
    {
        if (!scene_.empty() && bound != places_.end())
        {
            change_material(bound->second, object.shown);
        }
        return;
    }
    if (scene_.empty())
    {
        for (std::size_t i = 0; i < model_servers_.size(); ++i)
        {
            const bool is_of_it = model_servers_[i] == object.server_epoch &&
                                  parts_.models[i].hash == object.shown.model;
            if (is_of_it && news != dds::SceneNews::moves)
            {
                find_first(i, now);
            }
        }
        return;
    }
    if (news != dds::SceneNews::goes)
    {
        if (bound == places_.end())
        {
            offer(object, now);
        }
        return;
    }
    passed_over_.erase({name, object.generation});
    left_out_.erase({name, object.generation});
    if (bound != places_.end())
    {
        remove_object(bound->second);
    }
}

/// Lets our first object of the model follow the server's object of that model with the least
/// number; if there is none, our object follows none.
void SceneKeeper::find_first(std::size_t model, MonotonicTime now)
{
    const std::uint32_t place = first_[model];
    if (place == parts_.objects.size())
    {
        return;
    }
    const auto& objects = reader_->objects(model_servers_[model]);
    const auto first =
        std::ranges::find_if(objects, [&](const auto& entry)
                             { return entry.second.shown.model == parts_.models[model].hash; });
    if (first == objects.end())
    {
        unbind(place);
    }
    else if (slots_[place].bound != ServerObject{first->second.server_epoch, first->first})
    {
        bind(place, first->second, now);
    }
    else
    {
        move(place, first->second, now);
    }
}

/// Adds a server's object that we don't have yet, or logs why it can't be touched.
void SceneKeeper::offer(const dds::SeenObject& object, MonotonicTime now)
{
    const Generation name{{object.server_epoch, object.number}, object.generation};
    if (passed_over_.contains(name) || left_out_.contains(name))
    {
        return;
    }
    const auto model = model_of(object.shown.model);
    if (!model || is_of_tool(parts_.tools, *model))
    {
        passed_over_.insert(name);
        ++news_.passed_over;
        log_.write(
            fmt::format("object '{}' can't be touched: its model {} is {}", object.shown.name,
                        hash_text(object.shown.model),
                        model ? "the model of a tool" : "not one of the models at the start"));
        return;
    }
    if (!free_.empty())
    {
        bind(*free_.begin(), object, now);
        return;
    }
    left_out_.insert(name);
    ++news_.passed_over;
    log_.write(fmt::format("object '{}' can't be touched: --objects allows {}; use a larger value",
                           object.shown.name, slots_.size()));
}

void SceneKeeper::bind(std::uint32_t place, const dds::SeenObject& object, MonotonicTime now)
{
    unbind(place);
    Slot& slot = slots_[place];
    const ServerObject name{object.server_epoch, object.number};
    places_[name] = place;
    slot.bound = name;
    slot.known = {};
    if (!slot.is_resident)
    {
        free_.erase(place);
        slot.spec = {ModelId{static_cast<std::uint32_t>(*model_of(object.shown.model))},
                     material_for(name, object.shown)};
        slot.is_resident = true;
        slot.name = object.shown.name;
        untold_.push_back(place);
    }
    move(place, object, now);
}

void SceneKeeper::unbind(std::uint32_t place)
{
    if (slots_[place].bound)
    {
        places_.erase(*slots_[place].bound);
        slots_[place].bound.reset();
    }
}

void SceneKeeper::move(std::uint32_t place, const dds::SeenObject& object, MonotonicTime now)
{
    Slot& slot = slots_[place];
    slot.pose = pose_of(slot.spec.model.value, object);
    heard_[slot.spec.model.value] = now;
    if (slot.is_told)
    {
        mailbox_->put(place, slot.pose, now);
    }
}

/// Changes the material of our object. If several changes arrive while the queue is full, only the
/// newest is sent.
void SceneKeeper::change_material(std::uint32_t place, const ShownObject& shown)
{
    Slot& slot = slots_[place];
    const Material material = material_for(*slot.bound, shown);
    if (material == slot.spec.material)
    {
        return;
    }
    slot.spec.material = material;
    if (slot.is_told && !slot.owes_material)
    {
        slot.owes_material = true;
        untold_.push_back(place);
    }
}

/// Material for the frame: the one of --material or else the server's, limited by limited(). Logs
/// the first limit of each object.
Material SceneKeeper::material_for(const ServerObject& object, const ShownObject& shown)
{
    const Material& wanted = materials_.material_for(shown.name, shown.material);
    const Material material = limited(wanted, parts_.tools);
    if (material != wanted)
    {
        ++news_.limited;
        if (limited_.insert(object).second)
        {
            log_.write(fmt::format("the material of object '{}' is limited: {}", shown.name,
                                   differences(wanted, material)));
        }
    }
    return material;
}

void SceneKeeper::remove_object(std::uint32_t place)
{
    unbind(place);
    slots_[place].is_resident = false;
    untold_.push_back(place);
}

/// Queues added, removed and changed objects until the queue is full.
void SceneKeeper::pass_on(MonotonicTime now)
{
    while (!untold_.empty())
    {
        const std::uint32_t place = untold_.front();
        Slot& slot = slots_[place];
        if (slot.is_resident && !slot.is_told)
        {
            if (!mailbox_->try_add(place, slot.generation + 1, slot.spec, slot.pose, now))
            {
                return;
            }
            ++slot.generation;
            if (names_)
            {
                names_(place, slot.generation, slot.name);
            }
            ++news_.came;
            slot.owes_material = false; // An added object has its newest material.
        }
        else if (!slot.is_resident && slot.is_told)
        {
            if (!mailbox_->try_remove(place))
            {
                return;
            }
            ++news_.went;
        }
        else if (slot.is_resident && slot.owes_material)
        {
            if (!mailbox_->try_set_material(place, slot.spec.material))
            {
                return;
            }
            ++news_.feels;
            slot.owes_material = false;
        }
        slot.is_told = slot.is_resident;
        untold_.pop_front();
        if (!slot.is_resident)
        {
            free_.insert(place);
        }
    }
}

/// Adds the objects of left_out_ while there is room.
void SceneKeeper::offer_left_out(MonotonicTime now)
{
    while (!free_.empty() && !left_out_.empty())
    {
        const ServerObject name = left_out_.begin()->first;
        left_out_.erase(left_out_.begin());
        const auto& objects = reader_->objects(name.server_epoch);
        if (const auto object = objects.find(name.number); object != objects.end())
        {
            bind(*free_.begin(), object->second, now);
        }
    }
}

/// Notes which servers were heard, and adds their objects' new pose counts.
void SceneKeeper::note_heard(MonotonicTime now)
{
    for (const std::uint64_t epoch : servers_)
    {
        if (!reader_->was_heard(epoch))
        {
            continue;
        }
        const auto& objects = reader_->objects(epoch);
        for (auto at = places_.lower_bound({epoch, 0});
             at != places_.end() && at->first.server_epoch == epoch; ++at)
        {
            Slot& slot = slots_[at->second];
            const std::size_t model = slot.spec.model.value;
            heard_[model] = now;
            mailbox_->note_heard(at->second, now);
            const auto object = objects.find(at->first.number);
            if (object == objects.end())
            {
                continue;
            }
            const dds::PoseCounts& news = object->second.counts;
            counts_[model].accepted += news.accepted - slot.known.accepted;
            for (std::size_t k = 0; k < kPoseRefusals; ++k)
            {
                counts_[model].refused[k] += news.refused[k] - slot.known.refused[k];
            }
            slot.known = news;
        }
    }
}

/// Pose of our object for the server's pose, as Controller::poses() has them, with the server's
/// time.
ObjectPose SceneKeeper::pose_of(std::size_t model, const dds::SeenObject& object) const
{
    ObjectPose pose = object_pose(to_similarity(object.shown.pose), headers_[model]);
    pose.stamp_ns = object.server_time_ns;
    return pose;
}

std::optional<std::size_t> SceneKeeper::model_of(const ContentHash& hash) const
{
    const auto at = std::ranges::find(parts_.models, hash, &ServedModel::hash);
    return at == parts_.models.end()
               ? std::nullopt
               : std::optional(static_cast<std::size_t>(at - parts_.models.begin()));
}

} // namespace tactus::hrtc
