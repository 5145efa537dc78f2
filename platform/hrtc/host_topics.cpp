// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/host_topics.hpp"

#include "platform/hrtc/object_pose.hpp"

#include <utility>

namespace tactus::hrtc
{

Result<std::unique_ptr<HostTopics>, Refusal>
HostTopics::create(const dds::DdsClient& client, const Controller& controller, bool follows_poses)
{
    std::unique_ptr<HostTopics> topics(new HostTopics(controller));
    std::vector<ModelIdentity> identities;
    for (std::size_t i = 0; i < controller.models().size(); ++i)
    {
        const ServedModel& model = controller.models()[i];
        identities.push_back({model.name, model.hash, topics->headers_[i].fields().revision});
    }
    if (follows_poses)
    {
        auto poses = dds::PoseReader::create(client.domain(), client.catalogue(), identities);
        if (!poses)
        {
            return poses.error();
        }
        topics->poses_ = std::move(poses).value();
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

HostTopics::HostTopics(const Controller& controller)
    : controller_(controller), seen_(controller.models().size())
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
    take_poses(now);
    if (now - last_sent_ >= kTelemetryPeriod)
    {
        last_sent_ = now;
        send_telemetry();
    }
}

std::vector<dds::PoseCounts> HostTopics::pose_counts() const
{
    return poses_ != nullptr ? poses_->counts() : std::vector<dds::PoseCounts>{};
}

void HostTopics::take_poses(MonotonicTime now)
{
    if (poses_ == nullptr)
    {
        return;
    }
    poses_->poll(
        [&](const dds::PoseNews& news)
        {
            ObjectPose pose = object_pose(to_similarity(news.pose), headers_[news.object]);
            pose.stamp_ns = news.host_time_ns;
            door_->put(news.object, pose, now);
        });
}

void HostTopics::send_telemetry()
{
    Telemetry telemetry;
    if (!tap_->try_read(telemetry))
    {
        return; // No frame yet.
    }
    for (std::size_t i = 0; i < telemetry.model_count; ++i)
    {
        add_transport_side(i, telemetry.models[i]);
    }
    telemetry_->write(telemetry);
}

void HostTopics::add_transport_side(std::size_t model, ModelTelemetry& telemetry)
{
    const WaitingTimes& waiting = controller_.couriers()[model]->waiting_times();
    telemetry.host_gone = controller_.models()[model].link->state() == LinkState::host_gone;
    telemetry.pieces = waiting.total();
    Seen& seen = seen_[model];
    const auto news = static_cast<std::int64_t>(waiting.total() - seen.pieces);
    telemetry.piece_wait_ns = news > 0 ? (waiting.sum_ns() - seen.wait_ns) / news : 0;
    seen = {waiting.total(), waiting.sum_ns()};
    if (poses_ != nullptr)
    {
        const dds::PoseCounts& counts = poses_->counts()[model];
        telemetry.follows_poses = counts.accepted > 0;
        telemetry.poses_refused = counts.refused_in_all();
    }
}

} // namespace tactus::hrtc
