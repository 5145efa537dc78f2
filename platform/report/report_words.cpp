// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report.hpp"
#include "rt_core/records/safety.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <utility>

namespace tactus::hrtc
{

namespace
{

constexpr std::pair<const char*, const char*> kWords[] = {
    {"exact", "answer: the distance to the source mesh, up to rounding; good"},
    {"separated", "answer: the surface is proven to lie beyond the tool's reach; good"},
    {"bounded",
     "answer: two bounds of the distance, because data was missing or the work budget was spent"},
    {"within", "answer: as exact, but with coarser faces whose error is within the tolerance"},
    {"stale", "answer: the pose of a moved object is too old"},
    {"in contact", "share of the frames in which a tool touched an object"},
    {"with a force", "share of the frames in which a contact gave a force"},
    {"data-limited",
     "share of the frames in which a tool went only as far as the surface was known"},
    {"load, refine, refit, query, force",
     "stages of a frame: take pieces and request others; split and merge faces; update boxes; "
     "compute distances; compute forces"},
    {"frame", "time of all stages, device included"},
    {"cpu", "processor time of a frame"},
    {"wake", "wake-up latency: the delay of the loop by the machine"},
    {"response", "time from the deadline to the force, for deadlines without a frame too"},
    {"overrun", "deadline: the loop did something forbidden; a bug"},
    {"latency miss", "deadline: the machine delayed the loop; 'hrtc doctor' lists the causes"},
    {"stopped from outside", "deadline: the process was stopped and continued"},
    {"arrival", "time from the request for a piece of a model to its arrival"},
    {"static", "model that is loaded as a whole: it needs no server during the contact"},
    {"forces softened", "the stiffness was lowered to the stiffness limit of the device"},
    {"supervisor", "thread that brakes the devices if the loop stops"},
};

} // namespace

SummaryFacts report_words()
{
    SummaryFacts words(std::begin(kWords), std::end(kWords));
    for (std::size_t cause = 0; cause < kForceOffs; ++cause)
    {
        const auto& [why, back] = kForceOffWords[cause];
        words.emplace_back(kForceOffNames[cause],
                           fmt::format("force off: {}; returns {}", why, back));
    }
    return words;
}

} // namespace tactus::hrtc
