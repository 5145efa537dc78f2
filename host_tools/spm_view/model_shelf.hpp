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

/// The viewer's models by hash: those of files, and those added later. None is ever removed. Any
/// thread.
class ModelShelf
{
public:
    /// Opens the files; refused like ModelStore::open().
    [[nodiscard]] static Result<std::unique_ptr<ModelShelf>, Refusal>
    open(std::span<const std::string> files);

    /// Adds a model, unless one with its hash is present.
    void add(std::shared_ptr<KnownModel> model);
    /// Marks a model as in transit.
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

    /// The model; null if it is missing.
    [[nodiscard]] std::shared_ptr<KnownModel> find(const ContentHash& hash) const;

private:
    mutable std::mutex mutex_;
    std::vector<std::shared_ptr<KnownModel>> models_;
    std::set<ContentHash> coming_;
};

} // namespace tactus::view
