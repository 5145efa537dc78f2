// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/web_server.hpp"

#include "host_tools/spm_view/cut.hpp"
#include "host_tools/spm_view/feed.hpp"
#include "host_tools/spm_view/page.hpp"
#include "host_tools/spm_view/state_text.hpp"
#include "host_tools/web/loopback_server.hpp"
#include "transport/base/printable.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <deque>
#include <fstream>
#include <functional>
#include <httplib.h>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace tactus::view
{

namespace
{

using std::chrono::milliseconds;
using web::answer;
using web::LoopbackServer;
using Clock = std::chrono::steady_clock;

/// Shortest interval between two events to one viewer.
constexpr milliseconds kEventPeriod{50};
/// Longest interval between two events; one without news detects that a viewer is gone.
constexpr milliseconds kHeartbeat{1'000};
/// Interval at which waiting threads check whether the server ends.
constexpr milliseconds kLook{100};
/// Maximum number of states in one answer of /states.
constexpr std::uint64_t kStatesMax = 200;
/// Maximum number of kept answers of send_built(), which other viewers may request too.
constexpr std::size_t kKeptAnswers = 16;

/// Returns `tell(decoded model, pages)` for the model's cut in a refinement state. If the state
/// lacks pages (`is_whole` false), the pages have only the records that can be split without those.
template <typename Tell>
Result<std::string, Refusal> with_cut(KnownModel& model, const RefinementStateModel& front,
                                      bool is_whole, const Tell& tell)
{
    const auto decoded = decode_cut(model, front.pages, is_whole);
    if (!decoded)
    {
        return decoded.error();
    }
    return is_whole ? tell(decoded.value(), std::span<const RefinementStatePage>(front.pages))
                    : tell(decoded.value(), splittable_part(decoded.value(), front.pages));
}

struct Library
{
    const char* url;
    const char* file; ///< Path below Parts::libraries.
    const char* type;
};

constexpr std::array<Library, 4> kLibraries{{
    {"/lib/three.min.js", "three/three.min.js", "text/javascript"},
    {"/lib/OrbitControls.js", "three/examples/js/controls/OrbitControls.js", "text/javascript"},
    {"/lib/dygraph.min.js", "dygraphs/dygraph.min.js", "text/javascript"},
    {"/lib/dygraph.min.css", "dygraphs/dygraph.min.css", "text/css"},
}};

template <typename Number>
std::optional<Number> number_in(const std::string& text)
{
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional(number)
                                                                    : std::nullopt;
}

} // namespace

struct WebServer::Impl
{
    explicit Impl(const Parts& of) : parts(of) {}

    [[nodiscard]] std::optional<Refusal> read_libraries();
    void declare_answers();
    void declare_files();
    void declare_states();
    void declare_built();
    [[nodiscard]] std::string state_for(const httplib::Request& request) const;
    void send_states(const httplib::Request& request, httplib::Response& response) const;
    /// Server-sent events: the shortest interval between two, and the event for a snapshot; empty
    /// if it has nothing new.
    struct Events
    {
        milliseconds period;
        std::function<std::string(const Snapshot&)> event;
    };
    void send_events(httplib::Response& response, const Events& events);
    bool send_next(httplib::DataSink& sink, const Events& events, std::uint64_t& seen);
    void send_states_live(const httplib::Request& request, httplib::Response& response);
    void send_feed(const httplib::Request& request, httplib::Response& response);
    /// Builds the bytes of an answer about one model of a refinement state. `is_whole` is true if
    /// the state has all pages of the controller.
    using Build = std::function<Result<std::string, Refusal>(
        KnownModel&, const RefinementStateModel&, bool is_whole)>;
    void send_built(const httplib::Request& request, httplib::Response& response,
                    const std::string& what, const Build& build);
    [[nodiscard]] Result<std::shared_ptr<const std::string>, Refusal>
    built(const std::string& name, const std::function<Result<std::string, Refusal>()>& build);
    [[nodiscard]] std::shared_ptr<const std::string> find_kept(const std::string& name);

    Parts parts;
    std::map<std::string, std::string> libraries; ///< Contents by url.
    std::atomic<bool> ends{false};
    std::atomic<std::size_t> viewers{0};
    std::mutex kept_mutex; ///< Protects the members below.
    std::deque<std::pair<std::string, std::shared_ptr<const std::string>>> kept;
    LoopbackServer local{kThreads}; ///< Last member, since its threads use the others.
    httplib::Server& server{local.server()};
};

std::optional<Refusal> WebServer::Impl::read_libraries()
{
    for (const Library& library : kLibraries)
    {
        const std::filesystem::path path = parts.libraries / library.file;
        std::ifstream file(path, std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(file), {}};
        if (!file || text.empty())
        {
            return Refusal{
                path.string() +
                " can't be read; install Debian's packages libjs-three and libjs-dygraphs"};
        }
        libraries[library.url] = std::move(text);
    }
    return std::nullopt;
}

void WebServer::Impl::declare_answers()
{
    declare_files();
    declare_states();
    declare_built();
}

void WebServer::Impl::declare_files()
{
    using httplib::Request;
    using httplib::Response;
    for (const PageFile& file : page_files())
    {
        server.Get(file.url, [&file](const Request&, Response& response)
                   { response.set_content(file.text, file.type); });
    }
    // Browsers request the icon without a link to it.
    server.Get("/favicon.ico", [](const Request&, Response& response) { response.status = 204; });
    if (!parts.pages.empty())
    {
        server.set_mount_point("/pages", parts.pages);
    }
    for (const Library& library : kLibraries)
    {
        server.Get(library.url, [this, &library](const Request&, Response& response)
                   { response.set_content(libraries.at(library.url), library.type); });
    }
}

void WebServer::Impl::declare_states()
{
    using httplib::Request;
    using httplib::Response;
    server.Get("/state", [this](const Request& request, Response& response)
               { response.set_content(state_for(request), "application/json"); });
    server.Get("/states", [this](const Request& request, Response& response)
               { send_states(request, response); });
    server.Get("/metrics",
               [this](const Request&, Response& response)
               {
                   response.set_content(metrics_text(parts.films != nullptr
                                                         ? parts.films->at(parts.films->frames())
                                                         : *parts.live.newest()),
                                        web::kMetricsType);
               });
    server.Get("/events", [this](const Request& request, Response& response)
               { send_states_live(request, response); });
    server.Get("/feed", [this](const Request& request, Response& response)
               { send_feed(request, response); });
}

/// Declares the answers that are built from a controller's refinement state.
void WebServer::Impl::declare_built()
{
    using httplib::Request;
    using httplib::Response;
    server.Get("/front",
               [this](const Request& request, Response& response)
               {
                   send_built(
                       request, response, "faces",
                       [](KnownModel& model, const RefinementStateModel& front, bool is_whole)
                       {
                           const auto edits = model.edits();
                           return with_cut(model, front, is_whole,
                                           [&edits](const DecodedModel& decoded,
                                                    std::span<const RefinementStatePage> pages)
                                           { return cut_bytes(decoded, pages, edits.get()); });
                       });
               });
    server.Get("/loaded",
               [this](const Request& request, Response& response)
               {
                   send_built(request, response, "loaded",
                              [](KnownModel& model, const RefinementStateModel& front, bool)
                              { return chunk_box_bytes(model, chunks_of(front.pages)); });
               });
    server.Get("/requested",
               [this](const Request& request, Response& response)
               {
                   send_built(request, response, "requested",
                              [](KnownModel& model, const RefinementStateModel& front, bool)
                              { return chunk_box_bytes(model, front.requested); });
               });
    server.Get("/boxes",
               [this](const Request& request, Response& response)
               {
                   const auto level =
                       number_in<std::uint32_t>(request.get_param_value("level")).value_or(0);
                   send_built(
                       request, response, fmt::format("boxes{}", level),
                       [level](KnownModel& model, const RefinementStateModel& front, bool is_whole)
                       {
                           return with_cut(model, front, is_whole,
                                           [level](const DecodedModel& decoded,
                                                   std::span<const RefinementStatePage> pages)
                                           { return tree_box_bytes(decoded, pages, level); });
                       });
               });
}

std::string WebServer::Impl::state_for(const httplib::Request& request) const
{
    const std::string chosen = request.get_param_value("controller");
    if (parts.films == nullptr)
    {
        return state_json(*parts.live.newest(), parts.shelf, chosen, parts.domain);
    }
    const auto frame = number_in<std::uint64_t>(request.get_param_value("frame")).value_or(0);
    return state_json(parts.films->at(frame), parts.shelf, chosen, parts.domain, parts.films);
}

/// Sends `count` states of the films, `step` frames apart; the last one is that of `frame`.
void WebServer::Impl::send_states(const httplib::Request& request,
                                  httplib::Response& response) const
{
    const auto number = [&request](const char* name)
    { return number_in<std::uint64_t>(request.get_param_value(name)); };
    const auto frame = number("frame");
    const auto step = number("step");
    const auto count = number("count");
    const bool is_right = frame && step && *step > 0 && count && *count > 0 && *count <= kStatesMax;
    if (parts.films == nullptr || !is_right)
    {
        answer(
            response, parts.films == nullptr ? 404 : 400,
            fmt::format("/states needs a recording and frame=N&step=N&count=1 to {}", kStatesMax));
        return;
    }
    const std::uint64_t last = std::min(*frame, parts.films->frames() - 1);
    std::string states;
    for (std::uint64_t before = *count; before-- > 0;)
    {
        if (before <= last / *step)
        {
            states += states.empty() ? "[" : ",";
            states += state_json(parts.films->at(last - before * *step), parts.shelf,
                                 request.get_param_value("controller"), parts.domain, parts.films);
        }
    }
    response.set_content(states + "]", "application/json");
}

/// Sends the whole newest state at each change.
void WebServer::Impl::send_states_live(const httplib::Request& request, httplib::Response& response)
{
    const std::string chosen = request.get_param_value("controller");
    send_events(response, {kEventPeriod, [this, chosen](const Snapshot& news) {
                               return fmt::format("data: {}\n\n", state_json(news, parts.shelf,
                                                                             chosen, parts.domain));
                           }});
}

/// Sends each new state of one controller: that of an identity or name, or the first one.
void WebServer::Impl::send_feed(const httplib::Request& request, httplib::Response& response)
{
    if (parts.films != nullptr)
    {
        answer(response, 404, "/feed has live controllers only");
        return;
    }
    const auto event = [chosen = request.get_param_value("controller"),
                        last = std::optional<std::pair<dds::ControllerId, std::uint64_t>>()](
                           const Snapshot& news) mutable
    {
        const auto found = std::ranges::find_if(news.controllers,
                                                [&](const LiveController& each) {
                                                    return chosen.empty() ||
                                                           each.told.name == chosen ||
                                                           id_text(each.told.id) == chosen;
                                                });
        if (found == news.controllers.end() ||
            last == std::pair(found->told.id, found->told.serial))
        {
            return std::string();
        }
        last = std::pair(found->told.id, found->told.serial);
        return fmt::format("data: {}\n\n", feed_json(*found));
    };
    send_events(response, {milliseconds(0), event});
}

void WebServer::Impl::send_events(httplib::Response& response, const Events& events)
{
    if (viewers.fetch_add(1) >= kViewersMax)
    {
        viewers.fetch_sub(1);
        response.set_header("Retry-After", "5");
        answer(response, 503, fmt::format("{} viewers are connected; close one", kViewersMax));
        return;
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, events, seen = std::uint64_t{0}](std::size_t, httplib::DataSink& sink) mutable
        { return send_next(sink, events, seen); },
        [this](bool) { viewers.fetch_sub(1); });
}

/// Waits for news and sends one event for the newest state, so that a slow viewer skips states and
/// gets no old ones. `seen` is the serial of the last snapshot.
bool WebServer::Impl::send_next(httplib::DataSink& sink, const Events& events, std::uint64_t& seen)
{
    const auto start = Clock::now();
    std::string event;
    while (event.empty())
    {
        std::shared_ptr<const Snapshot> news = parts.live.wait_newer(seen, kLook);
        if (ends.load())
        {
            sink.done();
            return true;
        }
        if (news->serial > seen)
        {
            std::this_thread::sleep_until(start + events.period);
            news = parts.live.newest();
            seen = news->serial;
            event = events.event(*news);
        }
        if (event.empty() && Clock::now() - start >= kHeartbeat)
        {
            event = ": no news\n\n";
        }
    }
    return sink.write(event.data(), event.size());
}

void WebServer::Impl::send_built(const httplib::Request& request, httplib::Response& response,
                                 const std::string& what, const Build& build)
{
    const auto serial = number_in<std::uint64_t>(request.get_param_value("serial"));
    const auto hash = parse_hash(request.get_param_value("model"));
    if (!serial || !hash)
    {
        answer(response, 400, "controller=ID&serial=NUMBER&model=HASH is needed");
        return;
    }
    const std::string controller = request.get_param_value("controller");
    const StatePointer seen = parts.films != nullptr ? parts.films->state(controller, *serial)
                                                     : parts.live.state(controller, *serial);
    const auto model = parts.shelf.find(*hash);
    if (seen == nullptr || model == nullptr)
    {
        answer(response, 404,
               seen == nullptr ? "this refinement state is no longer kept"
                               : "the model is not loaded");
        return;
    }
    const RefinementStateModel front = model_in(seen->state, *hash);
    // Boxes of chunks depend on the numbers of the chunks, not on the split records.
    std::uint64_t chunks = 0xCBF2'9CE4'8422'2325U;
    for (const ChunkId chunk : what == "loaded"      ? chunks_of(front.pages)
                               : what == "requested" ? front.requested
                                                     : std::vector<ChunkId>{})
    {
        chunks = (chunks ^ chunk.value) * 0x0000'0100'0000'01B3U;
    }
    const std::string name = fmt::format("{} {} {:016x} {:016x} {}", what, hash_text(*hash),
                                         cut_id(front.pages), chunks, model->edit_revision());
    const auto bytes =
        built(name, [&] { return build(*model, front, seen->state.slots_left_out == 0); });
    if (!bytes)
    {
        answer(response, 409, bytes.error().text);
        return;
    }
    response.set_content(*bytes.value(), "application/octet-stream");
}

std::shared_ptr<const std::string> WebServer::Impl::find_kept(const std::string& name)
{
    const std::lock_guard lock(kept_mutex);
    const auto found = std::ranges::find(kept, name, &decltype(kept)::value_type::first);
    return found == kept.end() ? nullptr : found->second;
}

Result<std::shared_ptr<const std::string>, Refusal>
WebServer::Impl::built(const std::string& name,
                       const std::function<Result<std::string, Refusal>()>& build)
{
    if (auto known = find_kept(name))
    {
        return known;
    }
    auto bytes = build();
    if (!bytes)
    {
        return bytes.error();
    }
    const std::lock_guard lock(kept_mutex);
    kept.emplace_back(name, std::make_shared<const std::string>(std::move(bytes).value()));
    if (kept.size() > kKeptAnswers)
    {
        kept.pop_front();
    }
    return kept.back().second;
}

Result<std::unique_ptr<WebServer>, Refusal> WebServer::start(const Parts& parts, std::uint16_t port)
{
    std::error_code unknown;
    if (!parts.pages.empty() && !std::filesystem::is_directory(parts.pages, unknown))
    {
        return Refusal{fmt::format("--pages: '{}' is no folder", printable(parts.pages.string()))};
    }
    auto inside = std::make_unique<Impl>(parts);
    if (auto refusal = inside->read_libraries())
    {
        return *refusal;
    }
    inside->declare_answers();
    if (auto refusal = inside->local.start(port, "--port"))
    {
        return *refusal;
    }
    return std::unique_ptr<WebServer>(new WebServer(std::move(inside)));
}

WebServer::WebServer(std::unique_ptr<Impl> inside) : inside_(std::move(inside)) {}

WebServer::~WebServer()
{
    inside_->ends.store(true);
}

std::uint16_t WebServer::port() const noexcept
{
    return inside_->local.port();
}

} // namespace tactus::view
