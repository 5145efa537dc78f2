// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/store/store_link.hpp"

#include "transport/part_intake.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Maximum number of queued requests; beyond it the oldest are dropped, as on a server.
constexpr std::size_t kWaitingMax = 1'024;

} // namespace

StoreLink::StoreLink(ModelStore store, Log log) : store_(std::move(store)), log_(std::move(log))
{
    waiting_.reserve(2 * kWaitingMax);
    piece_.reserve(kMaxCodedChunkBytes);
}

void StoreLink::request(std::span<const ContentKey> keys, std::uint32_t /*generation*/)
{
    keys = keys.first(std::min(keys.size(), kWaitingMax));
    for (auto key = keys.rbegin(); key != keys.rend(); ++key)
    {
        waiting_.push_back(*key);
    }
    if (waiting_.size() > kWaitingMax)
    {
        waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(kWaitingMax));
    }
}

void StoreLink::poll(PieceSink& sink)
{
    while (!waiting_.empty())
    {
        const ContentKey key = waiting_.back();
        waiting_.pop_back();
        if (!try_read(key))
        {
            continue;
        }
        const auto piece = key.kind == ContentKind::base ? part_of(piece_, key.number)
                                                         : std::span(std::as_const(piece_));
        bytes_received_ += piece.size();
        sink.receive(key, piece);
    }
}

/// Reads a piece into piece_; for a part of the base mesh the whole base mesh. False if it is
/// damaged.
bool StoreLink::try_read(ContentKey key)
{
    const bool is_base = key.kind == ContentKind::base;
    const auto done = store_.read({key.kind, is_base ? 0 : key.number}, piece_);
    if (!done && damaged_.emplace(key.kind, key.number).second)
    {
        log_.write(done.error().text);
    }
    return static_cast<bool>(done);
}

Result<ServedModel, Refusal> serve_from_file(const std::filesystem::path& path,
                                             const std::string& name, Log log)
{
    auto store = ModelStore::open(path);
    if (!store)
    {
        return store.error();
    }
    ServedModel model;
    model.name = name;
    model.hash = store.value().hash();
    const auto header = store.value().header_bytes();
    model.header.assign(header.begin(), header.end());
    if (auto done = store.value().read({ContentKind::base, 0}, model.base); !done)
    {
        return done.error();
    }
    model.link = std::make_unique<StoreLink>(std::move(store).value(), std::move(log));
    return model;
}

} // namespace tactus
