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

// One thread, the one that uses the reader.
namespace tactus::dds
{

/// Identity of the controller that a sample states: the GUID of its participant.
template <typename Sample>
ControllerId controller_of(const Sample& sample)
{
    ControllerId id{};
    std::memcpy(id.data(), sample.controller, id.size());
    return id;
}

/// Takes new samples of a topic with one instance for each controller, and updates `seen`: the
/// newest state of at most `seen_max` controllers, in the order of discovery. Ended controllers are
/// removed. `read` converts a sample to a Seen, without `writer` and `is_disputed`; none refuses
/// the sample. Returns the number of refused samples, with those of controllers beyond `seen_max`;
/// `participants` counts them too. Bounded, never waits; allocates.
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
    // Only the controller's own participant can end the controller.
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
