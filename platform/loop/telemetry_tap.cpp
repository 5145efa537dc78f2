// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/telemetry_tap.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/telemetry_from_frame.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus::hrtc
{

void ObjectTap::copy(const ObjectTable& objects, std::span<const PairOutput> pairs) noexcept
{
    if (was_sent_)
    {
        copy_.sweep_begin = copy_.sweep_end < objects.capacity() ? copy_.sweep_end : 0;
    }
    copy_.sweep_end = std::min(copy_.sweep_begin + kObjectSweep, objects.capacity());
    copy_.objects.clear();
    for (std::uint32_t number = copy_.sweep_begin; number < copy_.sweep_end; ++number)
    {
        add(objects, number);
    }
    for (const PairOutput& pair : pairs)
    {
        const auto listed = copy_.objects.view();
        if (std::ranges::find(listed, pair.object, &ObjectsCopy::Object::number) == listed.end())
        {
            add(objects, pair.object);
        }
    }
}

void ObjectTap::add(const ObjectTable& objects, std::uint32_t number) noexcept
{
    const Object& object = objects[number];
    if (object.is_resident)
    {
        copy_.objects.push_back({number, object.spec.model.value, object.pose});
    }
}

void TelemetryTap::show(const ShownFrame& frame, const RunStatistics& statistics) noexcept
{
    TACTUS_ASSERT(frame.tools.size() <= kMaxTools);
    TACTUS_ASSERT(frame.output.pairs.size() <= kMaxPairs);
    news_.frame = statistics.frames;
    news_.time_ns = frame.start.ns;
    news_.exact = statistics.answers.exact;
    news_.separated = statistics.answers.separated;
    news_.bounded = statistics.answers.bounded;
    news_.stale = statistics.answers.stale;
    news_.within_tolerance = statistics.answers.within_tolerance;
    news_.missed = statistics.deadlines.missed;
    news_.overruns = statistics.deadlines.overruns;
    news_.latency_misses = statistics.deadlines.latency_misses;
    news_.faults_now = static_cast<std::uint32_t>(frame.output.faults);
    news_.faults_seen |= news_.faults_now;
    news_.tool_count = static_cast<std::uint32_t>(frame.tools.size());
    news_.pair_count = static_cast<std::uint32_t>(frame.output.pairs.size());
    news_.model_count = static_cast<std::uint32_t>(
        std::min<std::size_t>(frame.output.models.size(), kMaxShownModels));
    for (std::size_t i = 0; i < frame.tools.size(); ++i)
    {
        news_.tools[i] = telemetry_of(frame.tools[i], frame.devices[i], frame.output.tools[i]);
    }
    for (std::size_t i = 0; i < news_.model_count; ++i)
    {
        news_.models[i] = telemetry_of(frame.output.models[i]);
    }
    show_pairs(frame);
    mailbox_.write(news_);
    objects_.show(frame.objects, frame.output.pairs);
}

void TelemetryTap::show_pairs(const ShownFrame& frame) noexcept
{
    const std::span<const PairOutput> pairs = frame.output.pairs;
    std::array<Vec3, kMaxPairs> pushes_n;
    for (std::size_t begin = 0; begin < pairs.size();) // Pairs are sorted by tools.
    {
        const std::uint32_t tool = pairs[begin].tool;
        std::size_t end = begin + 1;
        while (end < pairs.size() && pairs[end].tool == tool)
        {
            ++end;
        }
        const Vec3 push_n = frame.output.tools[tool].in_contact ? Vec3(-frame.devices[tool].sent_n)
                                                                : Vec3(0.0, 0.0, 0.0);
        share_push(pairs.subspan(begin, end - begin), frame.radii_m[tool], push_n,
                   std::span(pushes_n).subspan(begin, end - begin));
        begin = end;
    }
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        news_.pairs[i] = telemetry_of(pairs[i]);
        news_.pairs[i].force_n = parts_of(pushes_n[i]);
    }
}

} // namespace tactus::hrtc
