// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/poses.hpp"

#include "transport/dds/take.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "tactus.h"

namespace tactus::dds
{

namespace
{

/// Samples taken in one poll: the reader keeps one for each object of each host.
constexpr std::size_t kPosesPerPoll = 256;

/// So that a publisher that starts again under the same epoch counts on from above its last one:
/// none sends a thousand million poses a second.
std::uint64_t first_serial()
{
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

} // namespace

Result<std::unique_ptr<PosePublisher>, Refusal>
PosePublisher::create(const Domain& domain, std::uint64_t host_epoch,
                      std::vector<ModelIdentity> objects)
{
    std::unique_ptr<PosePublisher> publisher(new PosePublisher(host_epoch, std::move(objects)));
    if (auto done = publisher->open_writers(domain); !done)
    {
        return done.error();
    }
    return publisher;
}

PosePublisher::PosePublisher(std::uint64_t host_epoch, std::vector<ModelIdentity> objects)
    : host_epoch_(host_epoch)
    , objects_(std::move(objects))
    , states_(objects_.size())
    , serial_(first_serial())
{
}

Result<Done, Refusal> PosePublisher::open_writers(const Domain& domain)
{
    std::vector<ContentHash> hashes;
    for (std::size_t i = 0; i < objects_.size(); ++i)
    {
        const auto at = std::ranges::find(hashes, objects_[i].hash);
        states_[i].writer = static_cast<std::size_t>(at - hashes.begin());
        if (at != hashes.end())
        {
            continue;
        }
        auto writer = make_writer(domain, Topic::poses, model_partition(objects_[i].hash));
        if (!writer)
        {
            return writer.error();
        }
        writers_.push_back(std::move(writer).value());
        hashes.push_back(objects_[i].hash);
    }
    return Done{};
}

Result<Done, PoseRefusal> PosePublisher::move(std::size_t object, const Pose& pose)
{
    TACTUS_ASSERT(object < objects_.size());
    const auto checked = checked_pose(pose);
    if (!checked)
    {
        return checked.error();
    }
    states_[object].pose = checked.value();
    states_[object].is_moved = true;
    send(object);
    return Done{};
}

void PosePublisher::repeat()
{
    const auto now = Clock::now();
    for (std::size_t i = 0; i < states_.size(); ++i)
    {
        if (states_[i].is_moved && now - states_[i].last_sent >= kPoseRepeat)
        {
            send(i);
        }
    }
}

void PosePublisher::send(std::size_t object)
{
    const ModelIdentity& identity = objects_[object];
    State& state = states_[object];
    state.last_sent = Clock::now();
    tactus_v1_ObjectPose sample = {};
    sample.host_epoch = host_epoch_;
    identity.name.copy(static_cast<char*>(sample.name), kMaxNameBytes);
    sample.protocol_version = kProtocolVersion;
    std::memcpy(sample.model_hash, identity.hash.data(), identity.hash.size());
    sample.revision = identity.revision;
    sample.serial = ++serial_;
    sample.host_time_ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(state.last_sent.time_since_epoch())
            .count();
    std::ranges::copy(state.pose.rotation, std::begin(sample.rotation));
    std::ranges::copy(state.pose.translation_m, std::begin(sample.translation_m));
    sample.scale = state.pose.scale;
    dds_write(writers_[state.writer].handle, &sample); // A failure is made good by the next one.
}

std::uint64_t PoseCounts::refused_in_all() const noexcept
{
    return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

Result<std::unique_ptr<PoseReader>, Refusal> PoseReader::create(const Domain& domain,
                                                                const Catalogue& catalogue,
                                                                std::vector<ModelIdentity> objects)
{
    std::unique_ptr<PoseReader> reader(new PoseReader(catalogue, std::move(objects)));
    std::vector<std::string> partitions;
    for (const ModelIdentity& object : reader->objects_)
    {
        partitions.push_back(model_partition(object.hash));
    }
    auto endpoint = make_reader(domain, Topic::poses, partitions);
    if (!endpoint)
    {
        return endpoint.error();
    }
    reader->reader_ = std::move(endpoint).value();
    return reader;
}

PoseReader::PoseReader(const Catalogue& catalogue, std::vector<ModelIdentity> objects)
    : catalogue_(catalogue)
    , objects_(std::move(objects))
    , last_(objects_.size())
    , counts_(objects_.size())
{
}

void PoseReader::poll(const std::function<void(const PoseNews&)>& take)
{
    take_each<tactus_v1_ObjectPose>(
        reader_.handle, kPosesPerPoll,
        [&](const tactus_v1_ObjectPose& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data)
            {
                take_sample(sample, take);
            }
        });
}

/// A model that is shown twice gives two objects of one name: both move.
void PoseReader::take_sample(const tactus_v1_ObjectPose& sample,
                             const std::function<void(const PoseNews&)>& take)
{
    const char* const text = static_cast<const char*>(sample.name);
    const std::string_view name(text, ::strnlen(text, sizeof(sample.name)));
    for (std::size_t i = 0; i < objects_.size(); ++i)
    {
        if (objects_[i].name != name)
        {
            continue;
        }
        const auto pose = judge(sample, i);
        if (!pose)
        {
            ++counts_[i].refused.at(static_cast<std::size_t>(pose.error()));
            continue;
        }
        ++counts_[i].accepted;
        last_[i] = {sample.host_epoch, sample.serial};
        take({i, pose.value(), sample.host_time_ns});
    }
}

Result<Pose, PoseRefusal> PoseReader::judge(const tactus_v1_ObjectPose& sample,
                                            std::size_t object) const
{
    const ModelIdentity& identity = objects_[object];
    if (sample.protocol_version != kProtocolVersion)
    {
        return PoseRefusal::version;
    }
    const bool is_same_model =
        std::memcmp(sample.model_hash, identity.hash.data(), identity.hash.size()) == 0;
    if (!is_same_model || sample.revision != identity.revision)
    {
        return PoseRefusal::model;
    }
    // The offer first seen, as for the model's link: where two hosts serve it, one moves it.
    const Catalogue::Offer* offer = catalogue_.find(ModelSelector{identity.name, identity.hash});
    if (offer == nullptr || offer->host_epoch != sample.host_epoch)
    {
        return PoseRefusal::host;
    }
    const Last& last = last_[object];
    if (sample.host_epoch == last.host_epoch && sample.serial <= last.serial)
    {
        return PoseRefusal::not_newer;
    }
    Pose pose;
    std::ranges::copy(sample.rotation, pose.rotation.begin());
    std::ranges::copy(sample.translation_m, pose.translation_m.begin());
    pose.scale = sample.scale;
    return checked_pose(pose);
}

} // namespace tactus::dds
