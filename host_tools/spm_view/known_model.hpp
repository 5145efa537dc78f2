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

/// A model whose faces the viewer can rebuild, from a file, a server or a recording. Any thread.
class KnownModel
{
public:
    virtual ~KnownModel() = default;
    KnownModel() = default;
    KnownModel(const KnownModel&) = delete;
    KnownModel& operator=(const KnownModel&) = delete;
    KnownModel(KnownModel&&) = delete;
    KnownModel& operator=(KnownModel&&) = delete;

    /// Name from its file or from its server.
    [[nodiscard]] virtual const std::string& name() const noexcept = 0;
    [[nodiscard]] virtual const ContentHash& hash() const noexcept = 0;
    [[nodiscard]] virtual const ModelHeader& header() const noexcept = 0;

    /// Waits until these pieces can be read, a second or two at most; then refused with the missing
    /// ones. The keys must be the model's.
    [[nodiscard]] virtual std::optional<Refusal> bring(std::span<const ContentKey> keys) = 0;
    /// Reads a piece in its coded form, verified against its hash; refused if it is missing. May
    /// wait for a disk.
    [[nodiscard]] virtual Result<Done, Refusal> read(ContentKey key,
                                                     std::vector<std::byte>& coded) = 0;
};

} // namespace tactus::view
