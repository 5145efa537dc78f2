// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

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

/// What became of a recording, for the report.
struct RecordingResult
{
    std::uint64_t frames{0};
    std::uint64_t bytes{0};
    std::uint64_t lost_from{kNoFrame}; ///< First frame that is missing; kNoFrame: none is.
};

/// Writes a run's recording, on a thread of its own, of ordinary priority, or where somebody calls
/// step(). Frames come from the haptic thread through a FrameTap, which never waits; pieces from
/// the transport thread.
class Recorder
{
public:
    enum class Worker : std::uint8_t
    {
        own_thread, ///< Starts here, so before the haptic thread: it inherits policy and processor.
        caller,     ///< Of step(), at least twice in the time that the tap holds.
    };
    /// The chunk loader must outlive the recorder, and nobody may run it while this is made or
    /// destroyed.
    Recorder(AtomicFile file, const RecordedSetup& setup, ChunkLoader& chunk_loader, Worker worker);
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;
    ~Recorder();

    /// What the haptic thread records through.
    [[nodiscard]] FrameTap& tap() noexcept { return tap_; }

    /// Keeps the name of an object that comes, for the file. Transport thread.
    void name_object(std::uint32_t number, std::uint32_t generation, const std::string& name);

    /// Writes what waits. The caller's thread, if that is the worker.
    void step();

    /// Adds the frame that failed; no frame runs any more.
    void add_failed(const GivenFrame& frame);

    /// Writes what waits, ends the recording and gives the file its name. Once, when no frame runs
    /// any more.
    [[nodiscard]] Result<RecordingResult, Refusal> finish();

private:
    struct Piece
    {
        std::uint32_t model{0};
        ContentKey key;
        std::vector<std::byte> bytes;
    };
    /// One model's pieces, on the transport thread.
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
    std::vector<Piece> pieces_; ///< Not yet in the writer; under the mutex, as the names are.
    std::map<RecordedName, std::string> names_;
    Result<Done, Refusal> stored_{Done{}};
    std::optional<WriterThread> thread_; ///< Last: it uses the others.
};

} // namespace tactus::hrtc
