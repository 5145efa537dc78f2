// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/host_topics.hpp"
#include "platform/loop/model_marks.hpp"
#include "platform/loop/trace_tap.hpp"
#include "platform/machine/time.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/served_model.hpp"

#include <atomic>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

/// What the transport does again and again: the chunk loader's round, a look at the hosts, and what
/// the topics have to say. When a host goes away or comes back, the model's link says so; the loop
/// goes on with what is resident.
class TransportRounds
{
public:
    /// Chunk loader and models outlive this; nobody else touches them or the models' links while
    /// rounds are run. `topics` has its turn after each round of the chunk loader; `trace` takes
    /// the times of those rounds of the chunk loader that do something. Either may be none.
    TransportRounds(ChunkLoader& chunk_loader, const std::vector<ServedModel>& models,
                    HostTopics* topics, TraceTap* trace = nullptr) noexcept
        : chunk_loader_(chunk_loader), models_(models), topics_(topics), trace_(trace)
    {
    }

    /// One thread at a time.
    void run(MonotonicTime now);

    /// Any thread: whether some model's host went away since the start.
    [[nodiscard]] bool host_was_lost() const noexcept { return host_was_lost_.load(); }
    /// Models whose host is gone now.
    [[nodiscard]] const ModelMarks& hosts_gone() const noexcept { return hosts_gone_; }
    /// Models of which something that is requested doesn't come (ChunkLoader::is_starved).
    [[nodiscard]] const ModelMarks& starved() const noexcept { return starved_; }

private:
    void run_chunk_loader(MonotonicTime now);
    void watch_models();

    ChunkLoader& chunk_loader_;
    const std::vector<ServedModel>& models_;
    HostTopics* topics_;
    TraceTap* trace_;
    TracedRound told_; ///< Sums since the start, as of the last round that was traced.
    std::atomic<bool> host_was_lost_{false};
    ModelMarks hosts_gone_;
    ModelMarks starved_;
};

/// Pause between two rounds: a request waits this long at most before it leaves.
inline constexpr Duration kRoundPause = microseconds(300);

/// Runs rounds on one thread of ordinary priority, a few thousand a second. Start it before the
/// haptic thread: threads inherit policy and processor.
class TransportThread
{
public:
    /// The rounds must outlive the thread.
    explicit TransportThread(TransportRounds& rounds);
    TransportThread(const TransportThread&) = delete;
    TransportThread& operator=(const TransportThread&) = delete;
    ~TransportThread();

private:
    void run();

    TransportRounds& rounds_;
    std::atomic<bool> stopped_{false};
    std::thread thread_;
};

} // namespace tactus::hrtc
