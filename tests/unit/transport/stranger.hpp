// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/topics.hpp"

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tactus.h"

namespace tactus::test
{

/// Forgeries of a piece.
enum class Forgery
{
    none,
    another_byte,
    cut_short,
    longer,
    empty,
    withheld,
};

inline std::vector<std::byte> forged(std::span<const std::byte> piece, Forgery how)
{
    std::vector<std::byte> bytes(piece.begin(), piece.end());
    switch (how)
    {
    case Forgery::none:
    case Forgery::withheld:
        break;
    case Forgery::another_byte:
        bytes[bytes.size() / 2] ^= std::byte{1};
        break;
    case Forgery::cut_short:
        bytes.pop_back();
        break;
    case Forgery::longer:
        bytes.push_back(std::byte{0});
        break;
    case Forgery::empty:
        bytes.clear();
        break;
    }
    return bytes;
}

/// Unauthenticated server that announces the model and sends any answers. Header and base mesh are
/// true.
struct Stranger
{
    /// Starts a server; `model` must outlive it.
    Stranger(std::uint32_t domain, const TinyModel& model, std::string name = "tiny",
             std::string scene = "")
        : model_(model)
        , name_(std::move(name))
        , scene_(std::move(scene))
        , domain_(dds::Domain::join(domain).value())
        , epoch_(dds::server_epoch_of(domain_.participants().own()))
        , catalogue_(std::move(make_writer(domain_, dds::Topic::catalogue, "")).value())
        , wanted_(std::move(make_reader(domain_, dds::Topic::wanted, dds::kAnyPartition)).value())
    {
        announce();
    }

    /// Forges pieces of this kind from now on.
    void forge(ContentKind kind, Forgery how) { forgeries_[kind] = how; }

    void step()
    {
        announce();
        dds::take_each<tactus_v5_Wanted>(
            wanted_.handle, 100,
            [this](const tactus_v5_Wanted& sample, const dds_sample_info_t& info)
            {
                if (info.valid_data && sample.server_epoch == epoch_)
                {
                    answer(sample);
                }
            });
    }

    [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
    [[nodiscard]] int sent(ContentKind kind) { return sent_by_kind_[kind]; }

private:
    void announce()
    {
        tactus_v5_CatalogueEntry entry = {};
        entry.server_epoch = epoch_;
        name_.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        scene_.copy(static_cast<char*>(entry.scene), kMaxNameBytes);
        const ContentHash hash = model_hash(model_.header);
        std::memcpy(entry.model_hash, hash.data(), hash.size());
        entry.faces = 1;
        entry.header_bytes = static_cast<std::uint32_t>(model_.header.size());
        entry.base_bytes = static_cast<std::uint32_t>(model_.base.size());
        dds_write(catalogue_.handle, &entry);
    }

    void answer(const tactus_v5_Wanted& wanted)
    {
        dds::ControllerId id{};
        std::memcpy(id.data(), wanted.controller, id.size());
        if (!chunks_)
        {
            const std::string name(static_cast<const char*>(wanted.controller_name));
            chunks_ = std::move(make_writer(domain_, dds::Topic::chunks,
                                            dds::controller_partition(name, id)))
                          .value();
        }
        if (!is_matched(*chunks_))
        {
            return; // The piece will be requested again.
        }
        for (std::uint32_t i = 0; i < wanted.pieces._length; ++i)
        {
            const tactus_v5_PieceName& name = wanted.pieces._buffer[i];
            send({static_cast<ContentKind>(name.kind), name.number});
        }
    }

    void send(ContentKey key)
    {
        if (forgeries_[key.kind] == Forgery::withheld)
        {
            return;
        }
        const bool is_part = key.kind == ContentKind::header || key.kind == ContentKind::base;
        const std::span<const std::byte> true_bytes =
            is_part ? std::span(key.kind == ContentKind::header ? model_.header : model_.base)
                    : model_.piece(key);
        const std::vector<std::byte> bytes = forged(true_bytes, forgeries_[key.kind]);
        std::vector<std::byte> payload;
        dds::append_piece(
            payload,
            {model_hash(model_.header), 0, static_cast<std::uint32_t>(key.kind), key.number},
            bytes);
        tactus_v5_Pieces sample = {};
        sample.server_epoch = epoch_;
        sample.sent = ++sent_;
        const auto count = static_cast<std::uint32_t>(payload.size());
        sample.payload = {count, count, reinterpret_cast<std::uint8_t*>(payload.data()), false};
        dds_write(chunks_->handle, &sample);
        ++sent_by_kind_[key.kind];
    }

    const TinyModel& model_;
    std::string name_;
    std::string scene_;
    dds::Domain domain_;
    std::uint64_t epoch_;
    dds::Endpoint catalogue_;
    dds::Endpoint wanted_;
    std::optional<dds::Endpoint> chunks_;
    std::uint64_t sent_{0};
    std::map<ContentKind, Forgery> forgeries_;
    std::map<ContentKind, int> sent_by_kind_;
};

} // namespace tactus::test
