// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/model_shelf.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/piece_exchange.hpp"
#include "transport/log.hpp"

#include <map>
#include <memory>

namespace tactus::view
{

class FetchedModel;

/// Brings models from the hosts that serve them to a shelf, by their hashes: header and base mesh
/// when one is looked for, pieces as they are asked for. Everything is verified as a controller
/// verifies it. One thread, but for the models on the shelf.
class ModelFetcher
{
public:
    /// Models that are looked for at most; further ones are passed over.
    static constexpr std::size_t kMaxModels = 256;

    /// All must outlive it and the shelf's use; `domain` was joined as Party::both.
    [[nodiscard]] static Result<std::unique_ptr<ModelFetcher>, Refusal>
    create(const dds::Domain& domain, ModelShelf& shelf, Log log);
    ModelFetcher(const ModelFetcher&) = delete;
    ModelFetcher& operator=(const ModelFetcher&) = delete;
    ~ModelFetcher();

    /// From now on, unless it is on the shelf already.
    void look_for(const ContentHash& hash);
    /// Takes what has come and asks for what is missing. Never waits.
    void step();
    /// Whether something is on its way: step again soon.
    [[nodiscard]] bool is_busy() const;

private:
    struct Search;

    ModelFetcher(dds::Catalogue catalogue, ModelShelf& shelf, Log log);

    void step(const ContentHash& hash, Search& search);
    void take_header(const ContentHash& hash, Search& search);

    dds::Catalogue catalogue_;
    ModelShelf& shelf_;
    Log log_;
    std::unique_ptr<dds::PieceExchange> exchange_; ///< From create() on.
    std::map<ContentHash, std::unique_ptr<Search>> searches_;
};

} // namespace tactus::view
