// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report_words.hpp"

namespace tactus::hrtc
{

namespace
{

constexpr ReportWord kWords[] = {
    {"exact", "answer: the distance to the original surface, to the last bit; good"},
    {"separated", "answer: proven clear of the surface, which lies beyond the tool's reach; good"},
    {"bounded", "answer: between two bounds, since data is missing or the work was too much"},
    {"within", "answer: as exact, but coarser faces that are off by no more count as the surface"},
    {"stale", "answer: an object moves, and its host was silent. Force off: that, or a device "
              "without a new sample for 20 ms"},
    {"in contact", "share of the frames in which a tool touched something"},
    {"with a force", "share of the frames in which that was felt, too"},
    {"data-limited",
     "share of the frames in which a tool went only as far as the surface is known"},
    {"load, refine, refit, query, force", "stages of a frame: take what came and ask for more; "
                                          "split and merge faces; boxes; distances; forces"},
    {"frame", "time of all stages, device included"},
    {"cpu", "processor time in it"},
    {"wake", "how much later than asked the machine woke the loop"},
    {"response", "from the deadline to the force, deadlines without a frame included"},
    {"overrun", "deadline: the loop did what it must not do; a bug"},
    {"latency miss", "deadline: the machine held the loop up; hrtc doctor says why"},
    {"stopped from outside", "deadline: the process was stopped and continued"},
    {"arrival", "from the request for a piece of a model to its being here"},
    {"static", "model that is here as a whole: it needs no host while it is touched"},
    {"forces softened", "the wall was made as soft as the device can carry"},
    {"velocity", "force off: the hand was faster than --speed-limit or the device's limit"},
    {"watchdog", "force off: the device makes no force, braked by the supervisor or by itself"},
    {"software", "force off: the run's own end"},
    {"disconnect", "force off: the device was gone"},
    {"deadman", "force off: nobody holds the device"},
    {"garbage", "force off: a sample or a force that can't be"},
    {"stall", "force off: frames were missed, mostly by the machine"},
    {"host", "force off: the host is gone, and the model isn't here as a whole"},
    {"assertion", "force off: a bug was found"},
    {"jump", "force off: the hand, or what it touched, went farther at once than it can"},
    {"halted", "force off: the surface at the tool isn't known yet"},
    {"over_constrained", "force off: objects leave the tool no room"},
    {"clutch", "force off: the button of --clutch is held"},
    {"starved", "force off: the tool waits at a model of which a piece hasn't come for a second"},
    {"growth", "force short: it would have grown faster than hand and objects moved"},
    {"supervisor", "a thread beside the loop, which brakes the devices when that is silent"},
};

} // namespace

std::span<const ReportWord> report_words() noexcept
{
    return kWords;
}

} // namespace tactus::hrtc
