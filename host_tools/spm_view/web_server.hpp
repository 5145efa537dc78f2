// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/film.hpp"
#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_shelf.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace tactus::view
{

/// Serves the page and its data on this machine's loopback interface (docs/view.md, docs/feed.md).
/// No request can change a controller.
class WebServer
{
public:
    /// Maximum number of browsers that receive events at the same time; each takes a thread.
    static constexpr std::size_t kViewersMax = 4;
    /// Number of threads: four more than viewers, for other requests.
    static constexpr std::size_t kThreads = kViewersMax + 4;

    struct Parts
    {
        const LiveState& live;
        ModelShelf& shelf;
        std::uint32_t domain{0};         ///< Number of the DDS domain that the page shows.
        std::filesystem::path libraries; ///< Folder with three and dygraphs.
        const Films* films{nullptr};     ///< Films in place of live data; null: live data.
        std::filesystem::path pages{};   ///< Folder of the user's pages; empty: none.
    };

    /// Listens on 127.0.0.1 until it is destroyed, which takes about 100 ms. The objects in `parts`
    /// must outlive the server. Port 0 takes any free port. Refused if the port is not free or the
    /// file of a library is missing.
    [[nodiscard]] static Result<std::unique_ptr<WebServer>, Refusal> start(const Parts& parts,
                                                                           std::uint16_t port);
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;
    ~WebServer();

    [[nodiscard]] std::uint16_t port() const noexcept;

private:
    struct Impl; ///< The only user of cpp-httplib.

    explicit WebServer(std::unique_ptr<Impl> inside);

    std::unique_ptr<Impl> inside_;
};

} // namespace tactus::view
