// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/dds/domain.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/topics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

// One thread, that of the reader.
namespace tactus::dds
{

/// Controller of a sample: the GUID of its participant.
template <typename Sample>
ControllerId controller_of(const Sample& sample)
{
    ControllerId id{};
    std::memcpy(id.data(), sample.controller, id.size());
    return id;
}

/// Takes new samples of a topic whose instances are controllers. `seen` then has the newest state
/// of each controller, in the order of discovery, at most `seen_max`; ended ones are removed.
/// `read` converts a sample to a Seen, except for Seen::writer and Seen::is_disputed, or returns
/// none if the sample is invalid. Returns the number of refused samples: invalid ones, and those of
/// controllers beyond `seen_max`. The participants' refusals count them as well. Bounded, never
/// waits; allocates.
template <typename Sample, typename Seen, typename Read>
[[nodiscard]] std::uint64_t take_newest(const Endpoint& reader, Participants& participants,
                                        std::size_t seen_max, std::vector<Seen>& seen,
                                        const Read& read)
{
    const auto try_take = [&](const Sample& sample, const dds_sample_info_t& info)
    {
        std::optional<Seen> news = read(sample);
        const auto known = std::ranges::find(seen, controller_of(sample), &Seen::id);
        if (!news || (known == seen.end() && seen.size() == seen_max))
        {
            return false;
        }
        news->writer = info.publication_handle;
        news->is_disputed = info.instance_state != DDS_ALIVE_INSTANCE_STATE;
        if (known != seen.end())
        {
            *known = *std::move(news);
        }
        else
        {
            seen.push_back(*std::move(news));
        }
        return true;
    };
    // Only the controller's own participant can end it.
    const auto end = [&](const ControllerId& controller, std::uint64_t writer)
    {
        const auto who = participants.writer_of(writer);
        if (who && *who != controller)
        {
            participants.refuse(writer, Refused::identity);
            return;
        }
        std::erase_if(seen, [&](const Seen& each) { return each.id == controller; });
    };
    std::uint64_t refused = 0;
    take_each<Sample>(reader.handle, seen_max,
                      [&](const Sample& sample, const dds_sample_info_t& info)
                      {
                          if (tells_end(info))
                          {
                              end(controller_of(sample), info.publication_handle);
                          }
                          else if (!try_take(sample, info))
                          {
                              ++refused;
                              participants.refuse(info.publication_handle, Refused::telemetry);
                          }
                      });
    std::erase_if(seen, [&](const Seen& each)
                  { return each.is_disputed && !participants.is_writing(each.writer); });
    return refused;
}

} // namespace tactus::dds
