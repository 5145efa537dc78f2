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

/// Repeated work of the transport: the chunk loader's round, a check of the hosts, and the topics'
/// step. The model's link reports the loss and return of its host. The loop continues with the
/// resident data.
class TransportRounds
{
public:
    /// Chunk loader and models must outlive the rounds. No other thread may touch them or the
    /// models' links meanwhile. `topics` steps after each round of the chunk loader. `trace` takes
    /// the times of the rounds with requests or pieces. Both may be null.
    TransportRounds(ChunkLoader& chunk_loader, const std::vector<ServedModel>& models,
                    HostTopics* topics, TraceTap* trace = nullptr) noexcept
        : chunk_loader_(chunk_loader), models_(models), topics_(topics), trace_(trace)
    {
    }

    /// Runs one round. One thread at a time.
    void run(MonotonicTime now);

    /// True if a model's host was lost since the start. Any thread.
    [[nodiscard]] bool host_was_lost() const noexcept { return host_was_lost_.load(); }
    /// Models whose host is lost at present.
    [[nodiscard]] const ModelMarks& hosts_gone() const noexcept { return hosts_gone_; }
    /// Models whose requested pieces are overdue (ChunkLoader::is_starved).
    [[nodiscard]] const ModelMarks& starved() const noexcept { return starved_; }

private:
    void run_chunk_loader(MonotonicTime now);
    void watch_models();

    ChunkLoader& chunk_loader_;
    const std::vector<ServedModel>& models_;
    HostTopics* topics_;
    TraceTap* trace_;
    TracedRound told_; ///< Sums from the start to the last traced round.
    std::atomic<bool> host_was_lost_{false};
    ModelMarks hosts_gone_;
    ModelMarks starved_;
};

/// Pause between two rounds, the longest delay of a request.
inline constexpr Duration kRoundPause = microseconds(300);

/// Runs rounds on one thread of ordinary priority, a few thousand a second. Start it before the
/// haptic thread, because threads inherit policy and processor.
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
