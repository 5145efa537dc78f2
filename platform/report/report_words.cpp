// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report.hpp"

namespace tactus::hrtc
{

namespace
{

constexpr ReportWord kWords[] = {
    {"exact", "answer: the distance to the source mesh, up to rounding; good"},
    {"separated", "answer: the surface is proven to lie beyond the tool's reach; good"},
    {"bounded",
     "answer: two bounds of the distance, because data was missing or the work budget was spent"},
    {"within", "answer: as exact, but with coarser faces whose error is within the tolerance"},
    {"stale", "answer: the pose of a moved object is too old. Force off: a stale answer in touch, "
              "or no new sample of the device for 20 ms"},
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
    {"velocity", "force off: the hand was faster than --speed-limit or the limit of the device"},
    {"watchdog",
     "force off: the device makes no force; it was braked by the supervisor or by itself"},
    {"software", "force off: the end of the run"},
    {"disconnect", "force off: the device was disconnected"},
    {"deadman", "force off: the user does not hold the device"},
    {"garbage", "force off: an invalid sample or force"},
    {"stall", "force off: frames were missed, mostly because of the machine"},
    {"server", "force off: the server was lost, and the model is not loaded as a whole"},
    {"assertion", "force off: an internal check found a bug"},
    {"jump", "force off: an object at the tool was removed or moved too far or too fast"},
    {"halted", "force off: the surface at the tool is not loaded yet"},
    {"over_constrained", "force off: objects leave the tool no room"},
    {"clutch", "force off: the button of --clutch is held"},
    {"starved", "force off: a piece of the model at the tool did not arrive within a second"},
    {"growth", "force limited: it would have grown faster than the hand and the objects moved"},
    {"supervisor", "thread that brakes the devices if the loop stops"},
};

} // namespace

std::span<const ReportWord> report_words() noexcept
{
    return kWords;
}

} // namespace tactus::hrtc
