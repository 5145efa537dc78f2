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

// One thread, the transport thread. poll() waits for the file.
namespace tactus
{

/// Link to a model in a local file (`--transport file`), in place of a server.
class StoreLink final : public ChunkLink
{
public:
    /// `log` gets a line for each piece that cannot be read, once and at a limited rate.
    StoreLink(ModelStore store, Log log);

    /// Queues pieces for poll(), at most 1,024. Beyond that the last `keys`, then the oldest
    /// requests, are dropped.
    void request(std::span<const ContentKey> keys, std::uint32_t generation) override;
    /// Reads all queued pieces and delivers them.
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
    std::vector<ContentKey> waiting_; ///< Queued pieces, highest priority last.
    std::vector<std::byte> piece_;
    std::set<std::pair<ContentKind, std::uint32_t>> damaged_;
    std::uint64_t bytes_received_{0};
};

/// Opens a file as a model named `name`, which must be valid (unchecked). Refused like
/// ModelStore::open(). Any thread except the haptic one.
[[nodiscard]] Result<ServedModel, Refusal> serve_from_file(const std::filesystem::path& path,
                                                           const std::string& name, Log log);

} // namespace tactus
