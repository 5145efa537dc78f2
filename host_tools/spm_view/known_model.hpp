// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/spm/content_key.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::view
{

/// A model whose faces the viewer can rebuild, wherever its pieces are: in a file, with a host, in
/// a recording. Any thread.
class KnownModel
{
public:
    virtual ~KnownModel() = default;
    KnownModel() = default;
    KnownModel(const KnownModel&) = delete;
    KnownModel& operator=(const KnownModel&) = delete;
    KnownModel(KnownModel&&) = delete;
    KnownModel& operator=(KnownModel&&) = delete;

    /// Of its file, or as its host calls it.
    [[nodiscard]] virtual const std::string& name() const noexcept = 0;
    [[nodiscard]] virtual const ContentHash& hash() const noexcept = 0;
    [[nodiscard]] virtual const ModelHeader& header() const noexcept = 0;

    /// Waits until these pieces can be read, a second or two at most: refused then, in words that
    /// say what is missing. The keys are the model's.
    [[nodiscard]] virtual std::optional<Refusal> bring(std::span<const ContentKey> keys) = 0;
    /// A piece in its coded form, verified against its hash; refused where it isn't here. May wait
    /// for a disk.
    [[nodiscard]] virtual Result<Done, Refusal> read(ContentKey key,
                                                     std::vector<std::byte>& coded) = 0;
};

} // namespace tactus::view
