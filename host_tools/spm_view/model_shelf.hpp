// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/known_model.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace tactus::view
{

/// The viewer's models by their hash, from files or added later. Models are never removed. Any
/// thread.
class ModelShelf
{
public:
    /// Opens the files; refused like ModelStore::open().
    [[nodiscard]] static Result<std::unique_ptr<ModelShelf>, Refusal>
    open(std::span<const std::string> files);

    /// Adds a model, unless the shelf has one with its hash.
    void add(std::shared_ptr<KnownModel> model);
    /// Records that a model is being fetched, for is_coming().
    void announce(const ContentHash& hash);

    struct Label
    {
        ContentHash hash{};
        std::string name;
        std::uint32_t faces{0};
    };
    [[nodiscard]] std::vector<Label> labels() const;
    [[nodiscard]] bool has(const ContentHash& hash) const { return find(hash) != nullptr; }
    [[nodiscard]] bool is_coming(const ContentHash& hash) const;

    /// The model with this hash; null if there is none.
    [[nodiscard]] std::shared_ptr<KnownModel> find(const ContentHash& hash) const;

private:
    mutable std::mutex mutex_;
    std::vector<std::shared_ptr<KnownModel>> models_;
    std::set<ContentHash> coming_;
};

} // namespace tactus::view
