// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/host_topics.hpp"

#include "platform/hrtc/object_pose.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tactus::hrtc
{

Result<std::unique_ptr<HostTopics>, Refusal>
HostTopics::create(dds::DdsClient& client, const Controller& controller, bool follows_poses)
{
    std::unique_ptr<HostTopics> topics(new HostTopics(client, controller));
    std::vector<ModelIdentity> identities;
    for (std::size_t i = 0; i < controller.models().size() && i < kMaxShownModels; ++i)
    {
        const ServedModel& model = controller.models()[i];
        identities.push_back({model.name, model.hash, topics->headers_[i].fields().revision});
    }
    if (follows_poses)
    {
        topics->scene_.emplace(client.domain(), client.exchange());
    }
    auto telemetry = dds::TelemetryWriter::create(client.domain(), client.controller_name(),
                                                  std::move(identities));
    if (!telemetry)
    {
        return telemetry.error();
    }
    topics->telemetry_ = std::move(telemetry).value();
    return topics;
}

HostTopics::HostTopics(dds::DdsClient& client, const Controller& controller)
    : catalogue_(client.catalogue())
    , controller_(controller)
    , followed_(controller.models().size())
    , moved_(controller.first_objects())
    , seen_(controller.models().size())
{
    for (const ServedModel& model : controller.models())
    {
        headers_.push_back(ModelHeader::parse(model.header).value());
    }
}

void HostTopics::connect(PoseDoor& door, const TelemetryTap& tap) noexcept
{
    door_ = &door;
    tap_ = &tap;
}

void HostTopics::step(MonotonicTime now)
{
    if (scene_)
    {
        choose_hosts();
        scene_->poll(hosts_, [&](dds::SceneNews news, const dds::SeenObject& object)
                     { take_news(news, object, now); });
        hear(now);
    }
    if (now - last_sent_ >= kTelemetryPeriod)
    {
        last_sent_ = now;
        send_telemetry(now);
    }
}

std::vector<dds::PoseCounts> HostTopics::pose_counts() const
{
    std::vector<dds::PoseCounts> counts;
    for (std::size_t i = 0; scene_ && i < followed_.size(); ++i)
    {
        counts.push_back(followed_[i].counts);
    }
    return counts;
}

/// The offer first seen, as for the model's link: where two hosts serve it, one moves it.
void HostTopics::choose_hosts()
{
    if (catalogue_.version() == seen_catalogue_)
    {
        return;
    }
    seen_catalogue_ = catalogue_.version();
    hosts_.clear();
    for (std::size_t i = 0; i < followed_.size(); ++i)
    {
        const ServedModel& model = controller_.models()[i];
        const dds::Catalogue::Offer* offer = catalogue_.find({model.name, model.hash});
        const std::uint64_t epoch = offer != nullptr ? offer->host_epoch : 0;
        if (followed_[i].host_epoch != epoch)
        {
            followed_[i].host_epoch = epoch;
            followed_[i].object.reset();
            followed_[i].known = {};
            for (const auto& [number, object] : scene_->objects(epoch)) // It may be known already.
            {
                follow(i, object, followed_[i].heard);
            }
        }
        if (epoch != 0 && std::ranges::find(hosts_, epoch) == hosts_.end())
        {
            hosts_.push_back(epoch);
        }
    }
}

void HostTopics::take_news(dds::SceneNews news, const dds::SeenObject& object, MonotonicTime now)
{
    for (std::size_t i = 0; i < followed_.size(); ++i)
    {
        Followed& followed = followed_[i];
        if (followed.host_epoch != object.host_epoch ||
            controller_.models()[i].hash != object.shown.model)
        {
            continue;
        }
        if (news != dds::SceneNews::goes)
        {
            follow(i, object, now);
        }
        else if (followed.object == object.number)
        {
            followed.object.reset();
            for (const auto& [number, other] : scene_->objects(object.host_epoch))
            {
                follow(i, other, now);
            }
        }
    }
}

/// Where it shows the model, and no object of a smaller number does.
void HostTopics::follow(std::size_t model, const dds::SeenObject& object, MonotonicTime now)
{
    Followed& followed = followed_[model];
    if (moved_[model] == controller_.objects().size()) // A tool; how its host shows it is all one.
    {
        return;
    }
    if (object.shown.model != controller_.models()[model].hash ||
        (followed.object && *followed.object < object.number))
    {
        return;
    }
    if (followed.object != object.number)
    {
        followed.object = object.number;
        followed.known = {};
    }
    ObjectPose pose = object_pose(to_similarity(object.shown.pose), headers_[model]);
    pose.stamp_ns = object.host_time_ns;
    door_->put(moved_[model], pose, now);
    followed.heard = now;
}

/// Of what is followed: its host was heard, and poses were counted.
void HostTopics::hear(MonotonicTime now)
{
    for (std::size_t i = 0; i < followed_.size(); ++i)
    {
        Followed& followed = followed_[i];
        if (!followed.object || !scene_->was_heard(followed.host_epoch))
        {
            continue;
        }
        followed.heard = now;
        door_->hear(moved_[i], now);
        const auto& objects = scene_->objects(followed.host_epoch);
        if (const auto object = objects.find(*followed.object); object != objects.end())
        {
            const dds::PoseCounts& news = object->second.counts;
            followed.counts.accepted += news.accepted - followed.known.accepted;
            for (std::size_t k = 0; k < kPoseRefusals; ++k)
            {
                followed.counts.refused[k] += news.refused[k] - followed.known.refused[k];
            }
            followed.known = news;
        }
    }
}

void HostTopics::send_telemetry(MonotonicTime now)
{
    Telemetry telemetry;
    if (!tap_->try_read(telemetry))
    {
        return; // No frame yet.
    }
    for (std::size_t i = 0; i < telemetry.model_count; ++i)
    {
        add_transport_side(i, telemetry.models[i], now);
    }
    for (std::size_t i = 0; i < telemetry.pair_count; ++i)
    {
        name_object(telemetry.pairs[i]);
    }
    telemetry_->write(telemetry);
}

void HostTopics::add_transport_side(std::size_t model, ModelTelemetry& telemetry, MonotonicTime now)
{
    const WaitingTimes& waiting =
        controller_.courier().waiting_times(static_cast<std::uint32_t>(model));
    telemetry.host_gone = controller_.models()[model].link->state() == LinkState::host_gone;
    telemetry.pieces = waiting.total();
    Seen& seen = seen_[model];
    const auto news = static_cast<std::int64_t>(waiting.total() - seen.pieces);
    telemetry.piece_wait_ns = news > 0 ? (waiting.sum_ns() - seen.wait_ns) / news : 0;
    seen = {waiting.total(), waiting.sum_ns()};
    const Followed& followed = followed_[model];
    telemetry.follows_poses = followed.counts.accepted > 0;
    telemetry.pose_age_ns = telemetry.follows_poses ? (now - followed.heard).ns : 0;
    telemetry.poses_refused = followed.counts.refused_in_all();
}

/// By its host and its number there, where a host shows it.
void HostTopics::name_object(PairTelemetry& pair) const
{
    const auto model = std::ranges::find(moved_, pair.object) - moved_.begin();
    if (model < std::ssize(moved_) && followed_[static_cast<std::size_t>(model)].object)
    {
        const Followed& followed = followed_[static_cast<std::size_t>(model)];
        pair.host_epoch = followed.host_epoch;
        pair.object = *followed.object;
    }
}

} // namespace tactus::hrtc
