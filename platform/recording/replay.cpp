// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/replay.hpp"

#include "platform/recording/replay_queues.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/base/number_form.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace tactus
{

namespace
{

struct alignas(Arena::kAlignment) CacheLine
{
    std::array<std::byte, Arena::kAlignment> bytes;
};

/// A frame made from a recording's setup, with its memory.
class ReplayedFrame
{
public:
    [[nodiscard]] static Result<std::unique_ptr<ReplayedFrame>, Refusal>
    create(const Recording& recording, const Kernels* kernels)
    {
        std::unique_ptr<ReplayedFrame> replayed(new ReplayedFrame(recording, kernels));
        if (const auto started =
                Frame::start(replayed->frame_, *replayed->arena_, replayed->setup_);
            !started)
        {
            return Refusal{std::string("no frame can be created from the recording's setup: ") +
                           refusal_text(started.error())};
        }
        replayed->queues_.emplace(recording, *replayed->frame_);
        return replayed;
    }

    [[nodiscard]] Frame& frame() noexcept { return *frame_; }
    /// Runs one frame and returns its difference from the recording, if any.
    [[nodiscard]] std::optional<std::string> step(const RecordedFrame& recorded,
                                                  std::uint64_t number, const ReplayWatch& watch)
    {
        if (auto fault = queues_->open(recorded))
        {
            return fault;
        }
        if (watch.begins)
        {
            watch.begins(number);
        }
        const FrameOutput output = frame_->run(recorded.input());
        if (watch.ends)
        {
            watch.ends(number, recorded, output);
        }
        return recorded.has_hashes
                   ? compare(output, recorded)
                   : std::optional<std::string>("it failed in the run, but not in the replay");
    }

private:
    ReplayedFrame(const Recording& recording, const Kernels* kernels)
    {
        const RecordedSetup& setup = recording.setup();
        for (const RecordedModel& model : setup.models)
        {
            sources_.push_back({model.header, model.base, model.capacities});
        }
        setup_.models = sources_;
        setup_.objects = setup.objects;
        setup_.poses = setup.poses;
        setup_.capacities = setup.capacities;
        setup_.for_streamed_models = setup.for_streamed_models;
        setup_.tools = setup.tools;
        setup_.period_ns = setup.period_ns;
        setup_.pose_age_max_ns = setup.pose_age_max_ns;
        setup_.static_when_it_fits = setup.static_when_it_fits;
        setup_.prediction = setup.prediction;
        setup_.force_tolerance_n = setup.force_tolerance_n;
        setup_.kernels = kernels;
        memory_.resize(Frame::required_bytes(setup_) / sizeof(CacheLine) + 1);
        arena_.emplace(std::as_writable_bytes(std::span(memory_)));
    }

    [[nodiscard]] static std::optional<std::string> compare(const FrameOutput& output,
                                                            const RecordedFrame& recorded)
    {
        if (output.queues.events.size() != recorded.events.size())
        {
            return std::to_string(output.queues.events.size()) + " of " +
                   std::to_string(recorded.events.size()) + " events were taken from the queues";
        }
        for (std::size_t i = 0; i < recorded.state_hashes.size(); ++i)
        {
            if (output.models[i].state_hash != recorded.state_hashes[i])
            {
                return "model " + std::to_string(i) + ": different faces are active (state hash)";
            }
        }
        const OutputHashes hashes = hash_output(output);
        const std::array<std::pair<bool, const char*>, 4> parts{
            {{hashes.tools == recorded.output.tools, "forces or proxies of the tools"},
             {hashes.pairs == recorded.output.pairs, "answers of the pairs"},
             {hashes.models == recorded.output.models, "pools of the models"},
             {hashes.work == recorded.output.work, "work counters or faults"}}};
        const auto* const part =
            std::find_if(parts.begin(), parts.end(), [](const auto& one) { return !one.first; });
        return part == parts.end() ? std::nullopt
                                   : std::optional(std::string("different ") + part->second);
    }

    std::vector<ModelSource> sources_;
    FrameSetup setup_;
    std::vector<CacheLine> memory_;
    std::optional<Arena> arena_;
    std::optional<Frame> frame_;
    std::optional<ReplayQueues> queues_;
};

} // namespace

Result<ReplayReport, Refusal> replay(const Recording& recording, const Kernels* kernels,
                                     const ReplayWatch& watch)
{
    if (!recording.keeps_run())
    {
        return Refusal{"can't be replayed: it holds only the last " +
                       counted(recording.frame_count(), "frame") +
                       " of a failed run; use it as --device replay:FILE"};
    }
    auto replayed = ReplayedFrame::create(recording, kernels);
    if (!replayed)
    {
        return replayed.error();
    }
    if (watch.made)
    {
        watch.made(replayed.value()->frame());
    }
    ReplayReport report;
    FrameDecoder decoder(recording.shape());
    for (ByteReader reader(recording.frames()); !reader.at_end();)
    {
        const char* fault = decoder.decode(reader);
        TACTUS_ASSERT(fault == nullptr); // The recording was checked completely.
        if (!decoder.frame().has_hashes && !watch.runs_failed)
        {
            break;
        }
        const std::uint64_t frame = report.frames++;
        if (auto difference = replayed.value()->step(decoder.frame(), frame, watch))
        {
            report.difference = {frame, std::move(*difference)};
            break;
        }
        if (watch.goes_on && !watch.goes_on())
        {
            break;
        }
    }
    return report;
}

std::string replay_line(const Recording& recording, const ReplayReport& report)
{
    const RecordedSetup& setup = recording.setup();
    std::string line =
        report.difference ? "frame " + std::to_string(report.difference->frame) +
                                " differs: " + report.difference->text
                          : counted(report.frames, "frame agrees", "frames agree") + " bit for bit";
    line += "; recorded by " + setup.compiler + ", " + setup.architecture + ", kernels " +
            setup.kernels;
    if (recording.has_failed() && !report.difference)
    {
        line += "; the next frame failed in the run";
    }
    if (const std::string missing = recording.missing(); !missing.empty())
    {
        line += "; " + missing;
    }
    return line;
}

} // namespace tactus
