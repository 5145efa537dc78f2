// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/writer_lanes.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <utility>

namespace tactus::dds
{

Result<WriterLanes, DdsError> WriterLanes::create(const Domain& domain, Topic topic,
                                                  const std::string& partition)
{
    WriterLanes lanes;
    for (Endpoint& writer : lanes.writers_)
    {
        auto made = make_writer(domain, topic, partition);
        if (!made)
        {
            return made.error();
        }
        writer = std::move(made).value();
    }
    return lanes;
}

bool WriterLanes::is_matched() const
{
    return std::ranges::any_of(writers_,
                               [](const Endpoint& writer) { return dds::is_matched(writer); });
}

bool WriterLanes::write(const void* sample)
{
    for (std::size_t i = 0; i < kLanes; ++i)
    {
        turn_ = (turn_ + 1) % kLanes;
        if (dds::is_matched(writers_[turn_]))
        {
            break;
        }
    }
    return dds_write(writers_[turn_].handle, sample) == DDS_RETCODE_OK;
}

} // namespace tactus::dds
