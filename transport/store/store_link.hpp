// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"
#include "transport/chunk_link.hpp"
#include "transport/log.hpp"
#include "transport/served_model.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

// One thread, the transport thread: poll() waits for the file.
namespace tactus
{

/// Serves a model from a local file with the same interface as a server (`--transport file`).
class StoreLink final : public ChunkLink
{
public:
    /// `log` gets a line for each piece that cannot be read, at a limited rate.
    StoreLink(ModelStore store, Log log);

    /// Up to 1,024 pieces may wait for poll(); beyond that the lowest-priority requests of the
    /// call, then the oldest, are dropped.
    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    /// Reads and delivers all waiting pieces.
    void poll(PieceSink& sink) override;
    [[nodiscard]] LinkState state() const override { return LinkState::connected; }
    [[nodiscard]] std::uint64_t session() const override { return 1; }
    [[nodiscard]] std::uint64_t bytes_received() const override { return bytes_received_; }

    [[nodiscard]] std::uint64_t damaged() const override { return damaged_.size(); }

    [[nodiscard]] const ModelStore& store() const noexcept { return store_; }

private:
    [[nodiscard]] bool try_read(ContentKey key);

    ModelStore store_;
    RateLimitedLog log_;
    std::vector<ContentKey> waiting_; ///< Waiting pieces, highest priority last.
    std::vector<std::byte> piece_;
    std::set<std::pair<ContentKind, std::uint32_t>> damaged_;
    std::uint64_t bytes_received_{0};
};

/// Opens a file as the model `name`, which must be valid (unchecked). Refused like
/// ModelStore::open(). Allocates; any thread, except the haptic one.
[[nodiscard]] Result<ServedModel, Refusal> serve_from_file(const std::filesystem::path& path,
                                                           const std::string& name, Log log);

} // namespace tactus
