// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/transport_thread.hpp"

#include "platform/controller/server_topics.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/scene/program_scene.hpp"
#include "transport/chunk_loader.hpp"

#include <chrono>
#include <cstddef>

namespace tactus::hrtc
{

void TransportRounds::run(MonotonicTime now)
{
    run_chunk_loader(now);
    watch_models();
    if (topics_ != nullptr)
    {
        topics_->step(now);
    }
    if (program_ != nullptr)
    {
        program_->step(now);
    }
}

void TransportRounds::run_chunk_loader(MonotonicTime now)
{
    chunk_loader_.step(now.ns);
    if (trace_ == nullptr)
    {
        return;
    }
    TracedRound sums;
    for (std::uint32_t model = 0; model < chunk_loader_.model_count(); ++model)
    {
        const ChunkLoaderCounters& counters = chunk_loader_.counters(model);
        sums.requests += counters.requests;
        sums.pieces += counters.pieces;
        sums.bytes += counters.coded_bytes;
        sums.delivered += counters.delivered;
        sums.refused += counters.refused();
    }
    if (sums.requests != told_.requests || sums.pieces != told_.pieces)
    {
        trace_->add(TracedRound{now, PosixClock().now(), sums.requests - told_.requests,
                                sums.pieces - told_.pieces, sums.bytes - told_.bytes,
                                sums.delivered - told_.delivered, sums.refused - told_.refused});
        told_ = sums;
    }
}

void TransportRounds::watch_models()
{
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        const bool is_gone = models_[i].link->state() == LinkState::server_gone;
        servers_gone_.set(i, is_gone);
        starved_.set(i, chunk_loader_.is_starved(static_cast<std::uint32_t>(i)));
        server_was_lost_.store(server_was_lost_.load() || is_gone);
    }
}

TransportThread::TransportThread(TransportRounds& rounds)
    : rounds_(rounds), thread_([this] { run(); })
{
}

/// Waits for the end of the present round.
TransportThread::~TransportThread()
{
    stopped_.store(true);
    thread_.join();
}

void TransportThread::run()
{
    const PosixClock clock;
    while (!stopped_.load())
    {
        rounds_.run(clock.now());
        std::this_thread::sleep_for(std::chrono::nanoseconds(kRoundPause.ns));
    }
}

} // namespace tactus::hrtc
