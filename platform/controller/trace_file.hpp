// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/run_results.hpp"
#include "platform/controller/writer_thread.hpp"
#include "platform/loop/trace_tap.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/base/refusal.hpp"

#include <optional>
#include <string>

namespace tactus::hrtc
{

/// Writes the times of frames, stages, queues and chunk loader in Chrome's trace format
/// (docs/report.md), on a thread of ordinary priority.
class TraceFile
{
public:
    /// Starts the thread. Call it before the haptic thread starts. `period`: period of the loop.
    TraceFile(AtomicFile file, Duration period);
    TraceFile(const TraceFile&) = delete;
    TraceFile& operator=(const TraceFile&) = delete;
    ~TraceFile();

    /// Tap for the haptic and the transport thread.
    [[nodiscard]] TraceTap& tap() noexcept { return tap_; }

    /// Writes the waiting events and commits the file. Call it once, when no other thread uses the
    /// tap any more.
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
    std::string text_; ///< Text that is not in the file yet.
    /// Zero of the file's times; none before the first event.
    std::optional<MonotonicTime> origin_;
    TraceResult result_;
    Result<Done, Refusal> stored_{Done{}};
    std::optional<WriterThread> thread_; ///< Last member, because it uses the others.
};

} // namespace tactus::hrtc
