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

/// Fetches models from their servers to a shelf, by their hashes: header and base mesh when a model
/// is requested, pieces on demand. All data are verified as in a controller. One thread, except for
/// the models on the shelf.
class ModelFetcher
{
public:
    /// Maximum number of requested models; further ones are ignored.
    static constexpr std::size_t kMaxModels = 256;

    /// All arguments must outlive the fetcher and the use of the shelf; `domain` must have been
    /// joined as Party::both.
    [[nodiscard]] static Result<std::unique_ptr<ModelFetcher>, Refusal>
    create(const dds::Domain& domain, ModelShelf& shelf, Log log);
    ModelFetcher(const ModelFetcher&) = delete;
    ModelFetcher& operator=(const ModelFetcher&) = delete;
    ~ModelFetcher();

    /// Requests a model, unless it is on the shelf already.
    void look_for(const ContentHash& hash);
    /// Takes arrivals and requests missing data. Never waits.
    void step();
    /// True while data are in transit: step again soon.
    [[nodiscard]] bool is_busy() const;

private:
    struct Search;

    ModelFetcher(dds::Catalogue catalogue, ModelShelf& shelf, Log log);

    void step(const ContentHash& hash, Search& search);
    void take_header(const ContentHash& hash, Search& search);

    dds::Catalogue catalogue_;
    ModelShelf& shelf_;
    Log log_;
    std::unique_ptr<dds::PieceExchange> exchange_; ///< Valid after create().
    std::map<ContentHash, std::unique_ptr<Search>> searches_;
};

} // namespace tactus::view
