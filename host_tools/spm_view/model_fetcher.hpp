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

/// Fetches models by their hashes from servers to a shelf: header and base mesh at once, pieces on
/// demand. All data are verified. One thread; the models on the shelf may be used by any thread.
class ModelFetcher
{
public:
    /// Maximum number of fetched models; further requests are ignored.
    static constexpr std::size_t kMaxModels = 256;

    /// All arguments must outlive the fetcher. `domain` must have been joined as Party::both.
    [[nodiscard]] static Result<std::unique_ptr<ModelFetcher>, Refusal>
    create(const dds::Domain& domain, ModelShelf& shelf, Log log);
    ModelFetcher(const ModelFetcher&) = delete;
    ModelFetcher& operator=(const ModelFetcher&) = delete;
    ~ModelFetcher();

    /// Requests a model, unless the shelf has it.
    void look_for(const ContentHash& hash);
    /// Takes arrivals and requests missing data. Never waits; call it often.
    void step();
    /// True while data are in transit: call step() again soon.
    [[nodiscard]] bool is_busy() const;

private:
    struct Search;

    ModelFetcher(const dds::Domain& domain, dds::Catalogue catalogue, ModelShelf& shelf, Log log);

    void step(const ContentHash& hash, Search& search);
    void take_header(const ContentHash& hash, Search& search);

    const dds::Domain& domain_;
    dds::Catalogue catalogue_;
    ModelShelf& shelf_;
    Log log_;
    std::unique_ptr<dds::PieceExchange> exchange_; ///< Valid after create().
    std::map<ContentHash, std::unique_ptr<Search>> searches_;
};

} // namespace tactus::view
