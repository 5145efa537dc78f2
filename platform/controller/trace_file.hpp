// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/writer_thread.hpp"
#include "platform/loop/trace_tap.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace tactus::hrtc
{

/// What became of a trace, for the report.
struct TraceResult
{
    std::uint64_t frames{0};
    std::uint64_t rounds{0}; ///< Rounds of the chunk loader that did something.
    std::uint64_t bytes{0};
    std::uint64_t lost{0}; ///< Frames and rounds that found no room.
};

/// Writes when each frame, its stages, the queues and the chunk loader did what, in Chrome's trace
/// format (docs/report.md), on a thread of its own, of ordinary priority.
class TraceFile
{
public:
    /// Starts the thread, so before the haptic one.
    TraceFile(AtomicFile file, Duration period);
    TraceFile(const TraceFile&) = delete;
    TraceFile& operator=(const TraceFile&) = delete;
    ~TraceFile();

    /// What the threads that work tell through.
    [[nodiscard]] TraceTap& tap() noexcept { return tap_; }

    /// Writes what waits and gives the file its name. Once, when nobody tells any more.
    [[nodiscard]] Result<TraceResult, Refusal> finish();

private:
    void step();
    void put(const TracedFrame& frame);
    void put(const TracedRound& round);
    void put_span(int row, const char* name, MonotonicTime start, Duration length,
                  const std::string& args);
    void put_instant(int row, const char* name, MonotonicTime at, const std::string& args);
    [[nodiscard]] std::string time_text(MonotonicTime at);
    void flush();

    AtomicFile file_;
    Duration period_;
    TraceTap tap_;
    std::string text_;                    ///< Not yet in the file.
    std::optional<MonotonicTime> origin_; ///< The file's zero.
    TraceResult result_;
    Result<Done, Refusal> stored_{Done{}};
    std::optional<WriterThread> thread_; ///< Last: it uses the others.
};

} // namespace tactus::hrtc
