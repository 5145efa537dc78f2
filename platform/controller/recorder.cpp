// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/recorder.hpp"

#include <utility>

namespace tactus::hrtc
{

Recorder::Recorder(AtomicFile file, const RecordedSetup& setup, ChunkLoader& chunk_loader,
                   Worker worker)
    : file_(std::move(file)), chunk_loader_(chunk_loader), writer_(setup)
{
    for (std::uint32_t model = 0; model < chunk_loader_.model_count(); ++model)
    {
        sinks_.push_back(std::make_unique<Sink>(*this, model));
        chunk_loader_.copy_pieces_to(sinks_.back().get(), model);
    }
    if (worker == Worker::own_thread)
    {
        thread_.emplace([this] { step(); });
    }
}

Recorder::~Recorder()
{
    stop();
    for (std::uint32_t model = 0; model < chunk_loader_.model_count(); ++model)
    {
        chunk_loader_.copy_pieces_to(nullptr, model);
    }
}

Result<RecordingResult, Refusal> Recorder::finish()
{
    stop();
    const std::uint64_t lost_from = tap_.lost_from();
    writer_.finish(lost_from);
    store();
    if (stored_)
    {
        stored_ = file_.commit();
    }
    if (!stored_)
    {
        return stored_.error();
    }
    return RecordingResult{writer_.frames(), file_.bytes(), lost_from};
}

void Recorder::add_failed(const GivenFrame& frame)
{
    stop();
    tap_.record_failed(frame);
}

void Recorder::name_object(std::uint32_t number, std::uint32_t generation, const std::string& name)
{
    const std::lock_guard lock(mutex_);
    names_[{RecordedName::Kind::object, number, generation}] = name;
}

void Recorder::stop()
{
    thread_.reset();
    take_frames();
}

void Recorder::step()
{
    take_frames();
    store();
}

/// Gives the waiting frames to the writer, each after its pieces. A piece is copied to `pieces_`
/// before it enters the queues, so the pieces of a finished frame are there.
void Recorder::take_frames()
{
    std::vector<std::byte> coded;
    while (tap_.try_take(coded))
    {
        take_pieces();
        writer_.add_frame(coded);
    }
}

void Recorder::take_pieces()
{
    std::vector<Piece> pieces;
    std::map<RecordedName, std::string> names;
    {
        const std::lock_guard lock(mutex_);
        pieces = std::exchange(pieces_, {});
        names = std::exchange(names_, {});
    }
    for (const auto& [what, name] : names)
    {
        writer_.add_name(what, name);
    }
    for (const Piece& piece : pieces)
    {
        writer_.add_piece(piece.model, piece.key, piece.bytes);
    }
}

/// Writes the writer's bytes to the file. After an error they are dropped, so they take no memory.
void Recorder::store()
{
    const std::vector<std::byte> bytes = writer_.take_bytes();
    if (stored_)
    {
        stored_ = file_.write(bytes);
    }
}

void Recorder::Sink::receive(ContentKey key, std::span<const std::byte> bytes)
{
    const std::lock_guard lock(recorder_.mutex_);
    recorder_.pieces_.push_back({model_, key, {bytes.begin(), bytes.end()}});
}

} // namespace tactus::hrtc
