// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/model_marks.hpp"
#include "platform/loop/trace_tap.hpp"
#include "platform/machine/time.hpp"

#include <atomic>
#include <thread>
#include <vector>

namespace tactus
{

class ChunkLoader;
struct ServedModel;

} // namespace tactus

namespace tactus::hrtc
{

class ProgramScene;
class ServerTopics;

/// Rounds of the transport: each runs the chunk loader's round, a check of the servers, and the
/// topics' step. The loss of a server is marked for its models; the loop continues with the
/// resident data.
class TransportRounds
{
public:
    /// Chunk loader and models must outlive the rounds. During run(), no other thread may touch
    /// them or the models' links. `topics` steps in each round, after the chunk loader. `trace`
    /// takes the times of the rounds with requests or pieces. `program` passes on the program's
    /// changes of the scene. All three may be null.
    TransportRounds(ChunkLoader& chunk_loader, const std::vector<ServedModel>& models,
                    ServerTopics* topics, TraceTap* trace = nullptr,
                    ProgramScene* program = nullptr) noexcept
        : chunk_loader_(chunk_loader)
        , models_(models)
        , topics_(topics)
        , trace_(trace)
        , program_(program)
    {
    }

    /// Runs one round at the time `now`. One thread at a time.
    void run(MonotonicTime now);

    /// True if a model's server was lost since the start. Any thread.
    [[nodiscard]] bool server_was_lost() const noexcept { return server_was_lost_.load(); }
    /// Models whose server is lost at present.
    [[nodiscard]] const ModelMarks& servers_gone() const noexcept { return servers_gone_; }
    /// Models whose requested pieces are overdue (ChunkLoader::is_starved).
    [[nodiscard]] const ModelMarks& starved() const noexcept { return starved_; }

private:
    void run_chunk_loader(MonotonicTime now);
    void watch_models();

    ChunkLoader& chunk_loader_;
    const std::vector<ServedModel>& models_;
    ServerTopics* topics_;
    TraceTap* trace_;
    ProgramScene* program_;
    TracedRound told_; ///< Sums of all rounds up to the last traced one.
    std::atomic<bool> server_was_lost_{false};
    ModelMarks servers_gone_;
    ModelMarks starved_;
};

/// Pause between two rounds, by which a request may be delayed.
inline constexpr Duration kRoundPause = microseconds(300);

/// Runs the rounds on one thread of ordinary priority, a few thousand a second. Make it before the
/// haptic thread, whose policy and processor it would inherit.
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
