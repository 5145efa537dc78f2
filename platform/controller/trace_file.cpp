// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/trace_file.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <iterator>
#include <span>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Rows of the trace, in the order of display.
enum Row : int
{
    kLoop = 1,
    kQueues = 2,
    kChunkLoader = 3,
};

/// Nanoseconds as text in microseconds, the unit of the format, with three decimals.
std::string microseconds_text(std::int64_t ns)
{
    const std::int64_t amount = std::abs(ns);
    return fmt::format("{}{}.{:03}", ns < 0 ? "-" : "", amount / 1'000, amount % 1'000);
}

std::string faults_text(FrameFault faults)
{
    std::string text;
    for (std::size_t bit = 0; bit < kFrameFaults; ++bit)
    {
        if (has_fault(faults, static_cast<FrameFault>(1U << bit)))
        {
            text += fmt::format("{}\"{}\"", text.empty() ? "" : ",", kFrameFaultNames[bit]);
        }
    }
    return "[" + text + "]";
}

} // namespace

TraceFile::TraceFile(AtomicFile file, Duration period) : file_(std::move(file)), period_(period)
{
    text_ = R"({"displayTimeUnit":"ns","traceEvents":[
{"name":"process_name","ph":"M","pid":1,"args":{"name":"hrtc"}})";
    for (const auto& [row, name] : {std::pair(kLoop, "haptic loop"), std::pair(kQueues, "queues"),
                                    std::pair(kChunkLoader, "chunk loader")})
    {
        text_ += fmt::format(
            ",\n{{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":{0},\"args\":"
            "{{\"name\":\"{1}\"}}}},\n{{\"name\":\"thread_sort_index\",\"ph\":\"M\",\"pid\":1,"
            "\"tid\":{0},\"args\":{{\"sort_index\":{0}}}}}",
            static_cast<int>(row), name);
    }
    thread_.emplace([this] { step(); });
}

TraceFile::~TraceFile()
{
    thread_.reset();
}

Result<TraceResult, Refusal> TraceFile::finish()
{
    thread_.reset();
    step();
    result_.lost = tap_.lost();
    text_ += fmt::format("\n],\"otherData\":{{\"lost\":{}}}}}\n", result_.lost);
    flush();
    if (stored_)
    {
        result_.bytes = file_.bytes();
        stored_ = file_.commit();
    }
    if (!stored_)
    {
        return stored_.error();
    }
    return result_;
}

void TraceFile::step()
{
    TracedFrame frame;
    while (tap_.try_take(frame))
    {
        put(frame);
        ++result_.frames;
    }
    TracedRound round;
    while (tap_.try_take(round))
    {
        put(round);
        ++result_.rounds;
    }
    flush();
}

/// Writes the text to the file. After an error it is dropped, so it takes no memory.
void TraceFile::flush()
{
    if (stored_)
    {
        stored_ = file_.write(std::as_bytes(std::span(text_)));
    }
    text_.clear();
}

/// Time in microseconds since the first written event, negative if `at` is earlier: another
/// thread's event may be.
std::string TraceFile::time_text(MonotonicTime at)
{
    origin_ = origin_.value_or(at);
    return microseconds_text((at - *origin_).ns);
}

void TraceFile::put_span(int row, const char* name, MonotonicTime start, Duration length,
                         const std::string& args)
{
    fmt::format_to(std::back_inserter(text_),
                   ",\n{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{},\"dur\":{}"
                   ",\"args\":{{{}}}}}",
                   name, row, time_text(start), microseconds_text(length.ns), args);
}

void TraceFile::put_instant(int row, const char* name, MonotonicTime at, const std::string& args)
{
    fmt::format_to(std::back_inserter(text_),
                   ",\n{{\"name\":\"{}\",\"ph\":\"i\",\"s\":\"t\",\"pid\":1,\"tid\":{},\"ts\":{}"
                   ",\"args\":{{{}}}}}",
                   name, row, time_text(at), args);
}

void TraceFile::put(const TracedFrame& frame)
{
    const Duration length = frame.end - frame.start;
    put_span(kLoop, "frame", frame.start, length,
             fmt::format("\"frame\":{},\"wake_us\":{},\"after_deadline_us\":{},\"in_contact\":{},"
                         "\"splits\":{},\"merges\":{},\"triangles\":{},\"faults\":{}",
                         frame.frame, microseconds_text(frame.wake_lateness.ns),
                         microseconds_text((frame.end - frame.deadline).ns), frame.in_contact,
                         frame.splits, frame.merges, frame.triangles, faults_text(frame.faults)));
    MonotonicTime at = frame.start;
    for (std::size_t i = 0; i < kStages; ++i)
    {
        put_span(kLoop, kStageNames[i], at, frame.stage[i], "");
        at = at + frame.stage[i];
    }
    put_span(kLoop, "write", at, frame.end - at, "");
    if (frame.end - frame.deadline > period_ || frame.periods > 1)
    {
        put_instant(kLoop, "deadline missed", frame.end,
                    fmt::format("\"periods\":{}", frame.periods));
    }
    if (frame.arrivals + frame.link_updates > 0)
    {
        put_instant(
            kQueues, "taken", frame.start,
            fmt::format("\"arrivals\":{},\"link_updates\":{}", frame.arrivals, frame.link_updates));
    }
    if (frame.requests > 0)
    {
        put_instant(kQueues, "requests", frame.start + frame.stage[0],
                    fmt::format("\"requests\":{}", frame.requests));
    }
}

void TraceFile::put(const TracedRound& round)
{
    put_span(kChunkLoader, "round", round.start, round.end - round.start,
             fmt::format("\"requests\":{},\"pieces\":{},\"bytes\":{},\"handed_over\":{},"
                         "\"refused\":{}",
                         round.requests, round.pieces, round.bytes, round.delivered,
                         round.refused));
}

} // namespace tactus::hrtc
