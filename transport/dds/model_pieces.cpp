// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/dds/model_pieces.hpp"

#include <fmt/format.h>

namespace tactus::dds
{

Result<ModelPieces, Refusal> ModelPieces::create(PublishedModel model)
{
    ModelPieces pieces(std::move(model));
    if (auto done = pieces.store().read({ContentKind::base, 0}, pieces.base_); !done)
    {
        return done.error();
    }
    const std::size_t header_bytes = pieces.store().header_bytes().size();
    if (header_bytes > kMaxHeaderBytes || pieces.base_.size() > kMaxBaseBytes)
    {
        return Refusal{fmt::format("model '{}' cannot be published: its header has {} bytes and "
                                   "its base mesh {}; at most {} and {} are allowed",
                                   pieces.model().name, header_bytes, pieces.base_.size(),
                                   kMaxHeaderBytes, kMaxBaseBytes)};
    }
    return pieces;
}

bool ModelPieces::has(ContentKey key) const noexcept
{
    const bool is_in_parts = key.kind == ContentKind::header || key.kind == ContentKind::base;
    return is_in_parts ? key.number < parts_of(whole(key.kind).size()) : store().has(key);
}

std::size_t ModelPieces::bytes(ContentKey key) const noexcept
{
    const auto all = whole(key.kind);
    return all.empty() ? store().coded_bytes(key) : part_of(all, key.number).size();
}

Result<Done, Refusal> ModelPieces::read(ContentKey key, std::vector<std::byte>& out) const
{
    const auto all = whole(key.kind);
    if (all.empty())
    {
        return store().read(key, out);
    }
    const auto part = part_of(all, key.number);
    out.assign(part.begin(), part.end());
    return Done{};
}

std::span<const std::byte> ModelPieces::whole(ContentKind kind) const noexcept
{
    switch (kind)
    {
    case ContentKind::header:
        return store().header_bytes();
    case ContentKind::base:
        return base_;
    default:
        return {};
    }
}

} // namespace tactus::dds
