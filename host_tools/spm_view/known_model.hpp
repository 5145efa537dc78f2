// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/spm/content_key.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_state.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::view
{

/// A model, from a file, a server or a recording, with which the viewer rebuilds faces. Any thread.
class KnownModel
{
public:
    virtual ~KnownModel() = default;
    KnownModel() = default;
    KnownModel(const KnownModel&) = delete;
    KnownModel& operator=(const KnownModel&) = delete;
    KnownModel(KnownModel&&) = delete;
    KnownModel& operator=(KnownModel&&) = delete;

    /// Name of its file, or name given by its server.
    [[nodiscard]] virtual const std::string& name() const noexcept = 0;
    [[nodiscard]] virtual const ContentHash& hash() const noexcept = 0;
    [[nodiscard]] virtual const ModelHeader& header() const noexcept = 0;

    /// Surface after the edits of its server so far; null without edits.
    [[nodiscard]] virtual std::shared_ptr<const EditState> edits() const { return nullptr; }
    /// Number of the last of these edits; 0: none.
    [[nodiscard]] virtual std::uint32_t edit_revision() const { return 0; }

    /// Waits, at most two seconds, until these pieces can be read. Refused if some are then
    /// missing; the refusal counts them. The model must have the keys.
    [[nodiscard]] virtual std::optional<Refusal> bring(std::span<const ContentKey> keys) = 0;
    /// Reads a verified piece in coded form. Refused if it is missing. May wait for a disk.
    [[nodiscard]] virtual Result<Done, Refusal> read(ContentKey key,
                                                     std::vector<std::byte>& coded) = 0;
};

} // namespace tactus::view
