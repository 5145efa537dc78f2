// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// squatter DOMAIN KIND NAME SCENE MODEL [COUNT]: an unintended server, until told to end. It
/// offers the model of the file MODEL under NAME, and the scene, "-" for none. KIND is its
/// behaviour:
///
///     silent   answers nothing
///     header   sends the header and nothing else
///     forger   sends the header, and everything else with a wrong byte
///     crowd    COUNT participants, each with 256 models of other names
///     claque   COUNT participants, each with 256 models of that name, hash and scene
///
/// Exits 2 on failure, 3 for an unknown KIND.

#include "platform/program/run_program.hpp"
#include "rt_core/limits.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/model_pieces.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/take.hpp"
#include "transport/dds/topics.hpp"
#include "transport/store/model_store.hpp"

#include <dds/dds.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tactus.h"

namespace
{

using namespace tactus;
using namespace std::chrono_literals;

template <typename T>
T needed(Result<T, Refusal>&& result)
{
    if (!result)
    {
        std::fprintf(stderr, "squatter: %s\n", result.error().text.c_str());
        std::exit(2);
    }
    return std::move(result).value();
}

/// One participant.
class Squatter
{
public:
    Squatter(std::uint32_t domain, const dds::ModelPieces& model, std::string scene)
        : model_(model)
        , scene_(std::move(scene))
        , domain_(needed(dds::Domain::join(domain)))
        , epoch_(domain_.participants().own_epoch())
        , catalogue_(needed(make_writer(domain_, dds::Topic::catalogue, "")))
    {
    }

    void offer(std::uint32_t number, const std::string& name, const ContentHash& hash)
    {
        tactus_v5_CatalogueEntry entry = {};
        entry.server_epoch = epoch_;
        entry.model = number;
        name.copy(static_cast<char*>(entry.name), kMaxNameBytes);
        scene_.copy(static_cast<char*>(entry.scene), kMaxNameBytes);
        std::memcpy(entry.model_hash, hash.data(), hash.size());
        const ModelStore& store = model_.store();
        entry.faces = store.header().fields().source_faces;
        entry.header_bytes = static_cast<std::uint32_t>(store.header_bytes().size());
        entry.base_bytes = store.header().fields().base_bytes;
        dds_write(catalogue_.handle, &entry);
    }
    /// Answers requests for header parts correctly; others not at all, or with a wrong byte.
    void answer(bool forges)
    {
        if (!wanted_.is_valid())
        {
            wanted_ = needed(make_reader(domain_, dds::Topic::wanted, dds::kAnyPartition));
        }
        dds::take_each<tactus_v5_Wanted>(
            wanted_.handle, 100,
            [&](const tactus_v5_Wanted& wanted, const dds_sample_info_t& info)
            {
                for (std::uint32_t i = 0; info.valid_data && i < wanted.pieces._length; ++i)
                {
                    const tactus_v5_PieceName& name = wanted.pieces._buffer[i];
                    const ContentKey key{static_cast<ContentKind>(name.kind), name.number};
                    if (forges || key.kind == ContentKind::header)
                    {
                        send(wanted, key, key.kind != ContentKind::header);
                    }
                }
            });
    }

private:
    void send(const tactus_v5_Wanted& to, ContentKey key, bool is_wrong)
    {
        dds::ControllerId id{};
        std::memcpy(id.data(), to.controller, id.size());
        const std::string name(static_cast<const char*>(to.controller_name));
        if (!chunks_.contains(id))
        {
            chunks_.emplace(id, needed(make_writer(domain_, dds::Topic::chunks,
                                                   dds::controller_partition(name, id))));
        }
        if (!is_matched(chunks_.at(id)))
        {
            return; // The piece will be requested again.
        }
        std::vector<std::byte> bytes;
        if (!model_.has(key) || !model_.read(key, bytes))
        {
            return;
        }
        bytes[bytes.size() / 2] ^= is_wrong ? std::byte{1} : std::byte{0};
        std::vector<std::byte> payload;
        dds::append_piece(
            payload, {model_.store().hash(), 0, static_cast<std::uint32_t>(key.kind), key.number},
            bytes);
        tactus_v5_Pieces sample = {};
        sample.server_epoch = epoch_;
        sample.sent = ++sent_;
        const auto count = static_cast<std::uint32_t>(payload.size());
        sample.payload = {count, count, reinterpret_cast<std::uint8_t*>(payload.data()), false};
        dds_write(chunks_.at(id).handle, &sample);
    }

    const dds::ModelPieces& model_;
    std::string scene_;
    dds::Domain domain_;
    std::uint64_t epoch_;
    dds::Endpoint catalogue_;
    dds::Endpoint wanted_; ///< Reader of requests, after the first answer().
    std::map<dds::ControllerId, dds::Endpoint> chunks_;
    std::uint64_t sent_{0};
};

} // namespace

int main(int argc, char** argv)
{
    const std::string kind = argc >= 6 ? argv[2] : "";
    const bool is_many = kind == "crowd" || kind == "claque";
    if (!is_many && kind != "silent" && kind != "header" && kind != "forger")
    {
        std::fprintf(stderr, "squatter DOMAIN silent|header|forger|crowd|claque NAME SCENE MODEL "
                             "[COUNT]\n");
        return 3;
    }
    const auto domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
    const std::string name = argv[3];
    const std::string scene = std::string(argv[4]) == "-" ? "" : argv[4];
    const auto model = needed(dds::ModelPieces::create({name, needed(ModelStore::open(argv[5]))}));
    const int count = is_many && argc >= 7 ? std::atoi(argv[6]) : 1;
    stop_on_signals();
    std::vector<std::unique_ptr<Squatter>> all;
    for (int i = 0; i < count; ++i)
    {
        all.push_back(std::make_unique<Squatter>(domain, model, kind == "crowd" ? "" : scene));
    }
    const auto announce = [&]
    {
        for (std::size_t who = 0; who < all.size(); ++who)
        {
            for (std::uint32_t number = 0; number < (is_many ? kMaxModels : 1); ++number)
            {
                ContentHash hash = model.store().hash();
                hash[0] ^= static_cast<std::uint8_t>(kind == "crowd" ? 1 + number : 0);
                all[who]->offer(number,
                                kind == "crowd"
                                    ? "bogus-" + std::to_string(who) + "-" + std::to_string(number)
                                    : name,
                                hash);
            }
        }
    };
    announce();
    std::printf("ready on DDS domain %u\n", domain);
    std::fflush(stdout);
    auto announced = std::chrono::steady_clock::now();
    while (!is_stop_requested())
    {
        if (std::chrono::steady_clock::now() - announced >= 1s)
        {
            announced = std::chrono::steady_clock::now();
            announce();
        }
        if (kind == "header" || kind == "forger")
        {
            all.front()->answer(kind == "forger");
        }
        std::this_thread::sleep_for(2ms);
    }
    return 0;
}
