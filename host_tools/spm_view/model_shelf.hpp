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

/// The models that the viewer has, by their hashes: those of files, and those that others add. None
/// is ever taken away. Any thread.
class ModelShelf
{
public:
    /// Refused as ModelStore::open() is.
    [[nodiscard]] static Result<std::unique_ptr<ModelShelf>, Refusal>
    open(std::span<const std::string> files);

    /// One of a hash that is here already changes nothing.
    void add(std::shared_ptr<KnownModel> model);
    /// It isn't here yet, but somebody brings it.
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

    /// Null where there is no such model.
    [[nodiscard]] std::shared_ptr<KnownModel> find(const ContentHash& hash) const;

private:
    mutable std::mutex mutex_;
    std::vector<std::shared_ptr<KnownModel>> models_;
    std::set<ContentHash> coming_;
};

} // namespace tactus::view
