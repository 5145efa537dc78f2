// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/writer_lanes.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <utility>

namespace tactus::dds
{

WriterLanes::WriterLanes(const Domain& domain, Topic topic, std::string partition)
    : domain_(&domain), topic_(topic), partition_(std::move(partition))
{
}

Result<WriterLanes, Refusal> WriterLanes::create(const Domain& domain, Topic topic,
                                                 const std::string& partition)
{
    auto first = make_writer(domain, topic, partition);
    if (!first)
    {
        return first.error();
    }
    WriterLanes lanes(domain, topic, partition);
    lanes.lanes_.push_back({std::move(first).value(), true, true, 0});
    return lanes;
}

std::size_t WriterLanes::open() const
{
    return static_cast<std::size_t>(std::ranges::count_if(lanes_, &Lane::is_open));
}

bool WriterLanes::write(const void* sample, const void* probe, std::size_t bytes)
{
    open_next(probe);
    ++written_;
    for (std::size_t i = 0; i < lanes_.size(); ++i)
    {
        turn_ = (turn_ + 1) % lanes_.size();
        Lane& lane = lanes_[turn_];
        // The lane lost its reader: it must be probed again.
        if (lane.is_open && turn_ != 0 && !dds::is_matched(lane.writer))
        {
            lane.is_open = lane.is_probed = false;
        }
        if (lane.is_open && has_room(lane))
        {
            lane.unacked_bytes += bytes;
            return dds_write(lane.writer.handle, sample) == DDS_RETCODE_OK;
        }
    }
    return false;
}

bool WriterLanes::has_room(Lane& lane)
{
    if (lane.unacked_bytes > kUnackedMax &&
        dds_wait_for_acks(lane.writer.handle, 0) == DDS_RETCODE_OK)
    {
        lane.unacked_bytes = 0;
    }
    return lane.unacked_bytes <= kUnackedMax;
}

std::shared_ptr<void> WriterLanes::try_renew(Backoff::Clock::time_point now)
{
    if (!renewals_.is_due(now))
    {
        return nullptr;
    }
    renewals_.begin(now);
    auto first = make_writer(*domain_, topic_, partition_);
    if (!first)
    {
        return nullptr;
    }
    auto old = std::make_shared<std::vector<Lane>>(std::move(lanes_));
    lanes_.clear();
    lanes_.push_back({std::move(first).value(), true, true, 0});
    turn_ = written_ = 0;
    return old;
}

/// Takes the next step to open a further writer: creates it, sends the probe, or checks the answer.
void WriterLanes::open_next(const void* probe)
{
    const auto next = std::ranges::find(lanes_, false, &Lane::is_open);
    if (next == lanes_.end())
    {
        const bool is_due = lanes_.size() < kLanes && written_ >= kSamplesALane * lanes_.size();
        if (is_due)
        {
            if (auto writer = make_writer(*domain_, topic_, partition_))
            {
                lanes_.push_back({std::move(writer).value(), false, false, 0});
            }
        }
        return;
    }
    if (!next->is_probed)
    {
        next->is_probed = dds::is_matched(next->writer) &&
                          dds_write(next->writer.handle, probe) == DDS_RETCODE_OK;
        return;
    }
    next->is_open = dds::is_matched(next->writer) &&
                    dds_wait_for_acks(next->writer.handle, 0) == DDS_RETCODE_OK;
}

} // namespace tactus::dds
