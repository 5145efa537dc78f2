// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/run_results.hpp"
#include "platform/controller/writer_thread.hpp"
#include "platform/recording/frame_tap.hpp"
#include "platform/recording/recording_writer.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/base/refusal.hpp"
#include "transport/chunk_loader.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Writes a run's recording, on its own thread of ordinary priority or in the caller's step().
/// Frames arrive from the haptic thread through a FrameTap, which never waits. Pieces arrive from
/// the transport thread.
class Recorder
{
public:
    enum class Worker : std::uint8_t
    {
        /// A thread of the recorder. Make the recorder before the haptic thread, whose policy and
        /// processor the thread would inherit.
        own_thread,
        /// The thread that calls step(). It must do so at least twice in the time that FrameTap can
        /// hold.
        caller,
    };
    /// The chunk loader must outlive the recorder. It must not run while the recorder is made or
    /// destroyed.
    Recorder(AtomicFile file, const RecordedSetup& setup, ChunkLoader& chunk_loader, Worker worker);
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;
    ~Recorder();

    /// Tap for the haptic thread.
    [[nodiscard]] FrameTap& tap() noexcept { return tap_; }

    /// Keeps the name of an added object for the file. Transport thread.
    void name_object(std::uint32_t number, std::uint32_t generation, const std::string& name);

    /// Writes the waiting frames and pieces. With Worker::caller, for that thread only.
    void step();

    /// Adds the failed frame at the end. Call it when no frame runs any more.
    void add_failed(const GivenFrame& frame);

    /// Writes the remaining frames, ends the recording and commits the file. Call it once, when no
    /// frame runs any more.
    [[nodiscard]] Result<RecordingResult, Refusal> finish();

private:
    struct Piece
    {
        std::uint32_t model{0};
        ContentKey key;
        std::vector<std::byte> bytes;
    };
    /// Sink for the pieces of one model, on the transport thread.
    class Sink final : public PieceSink
    {
    public:
        Sink(Recorder& recorder, std::uint32_t model) : recorder_(recorder), model_(model) {}
        void receive(ContentKey key, std::span<const std::byte> bytes) override;

    private:
        Recorder& recorder_;
        std::uint32_t model_;
    };

    void stop();
    void take_frames();
    void take_pieces();
    void store();

    AtomicFile file_;
    ChunkLoader& chunk_loader_;
    std::vector<std::unique_ptr<Sink>> sinks_;
    FrameTap tap_;
    RecordingWriter writer_;
    std::mutex mutex_;
    std::vector<Piece> pieces_; ///< Pieces for `writer_`. `mutex_` guards them and `names_`.
    std::map<RecordedName, std::string> names_;
    Result<Done, Refusal> stored_{Done{}};
    std::optional<WriterThread> thread_; ///< Last member, because it uses the others.
};

} // namespace tactus::hrtc
