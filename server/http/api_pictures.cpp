#include "server/http/api_pictures.hpp"

#include "core/bytes.hpp"
#include "server/wire/words.hpp"

namespace smokemap::server {
namespace {

constexpr std::size_t kMostPictureBytes = 25_MiB;
constexpr std::size_t kMostReadBody = 16_KiB;
constexpr std::int64_t kMostPages = 10'000;

std::string parameter(const Request& request, std::string_view name) {
  const auto it = request.path_parameters.find(name);
  return it == request.path_parameters.end() ? std::string() : it->second;
}

std::string query_text(const Request& request, std::string_view name) {
  const auto it = request.query.find(name);
  return it == request.query.end() ? std::string() : it->second;
}

Response upload_plan(const ApiParts& p, const Request& request) {
  const std::int64_t page = query_text(request, "page").empty() ? 1 : query_number(request, "page").value_or(0);
  if (page < 1 || page > kMostPages) return error_response(400, "invalid_argument", "page must be a number from 1");
  const std::string patience = query_text(request, "patience");
  if (!patience.empty() && patience != "0" && patience != "1")
    return error_response(400, "invalid_argument", "patience must be 0 or 1");
  const auto picture = p.pictures.clean(request.body, static_cast<int>(page), patience == "1");
  if (!picture) return error_response(picture.error());
  const auto sha = p.files.put(picture->bytes);
  if (!sha) return error_response(sha.error());
  const auto kept = p.store.add_picture(
      {*sha, "picture", *sha, picture->media_type, picture->width_px, picture->height_px, p.clock->now() / 1'000'000});
  if (!kept) return error_response(kept.error());
  return json_response({{"plan_id", *sha},
                        {"width", picture->width_px},
                        {"height", picture->height_px},
                        {"warnings", picture->warnings}});
}

Response stored_picture(const ApiParts& p, const Request& request, const char* kind) {
  const std::string version = query_text(request, "v");
  const auto record = p.store.picture(parameter(request, "id"), kind, version);
  if (!record) return error_response(record.error());
  if (!*record) return error_response(404, "not_found", "there is no such picture");
  auto bytes = p.files.get((*record)->sha256);
  if (!bytes) return error_response(bytes.error());
  Response response = bytes_response(std::move(*bytes), (*record)->media_type);
  const bool fixed = std::string_view(kind) == "picture" || !version.empty();  // the address names the content
  response.headers.emplace_back("Cache-Control", fixed ? "private, max-age=31536000, immutable" : "no-cache");
  return response;
}

Result<PlanReadRequest> read_request(const Request& request) {
  PlanReadRequest asked;
  if (request.body.empty()) return asked;
  const auto json = parse_json(request.body);
  if (!json) return json.error();
  Fields f(*json, "read");
  if (f.has("corners")) {
    const auto corners = f.points("corners", 4, 4);
    if (corners.size() == 4) asked.corners_px = {corners[0], corners[1], corners[2], corners[3]};
  }
  if (f.has("metres_per_pixel")) asked.metres_per_pixel = f.number("metres_per_pixel", 1e-5, 100);
  if (f.has("plan_at")) asked.plan_at_px = f.point("plan_at");
  if (!f.ok()) return f.error();
  return asked;
}

Response read_plan(const ApiParts& p, const Request& request) {
  const std::string plan = parameter(request, "id");
  const auto asked = read_request(request);
  if (!asked) return error_response(asked.error());
  const auto record = p.store.picture(plan, "picture");
  if (!record) return error_response(record.error());
  if (!*record) return error_response(404, "not_found", "there is no such plan");
  const auto bytes = p.files.get((*record)->sha256);
  if (!bytes) return error_response(bytes.error());
  const auto reading = p.pictures.read_layout(*bytes, *asked);
  if (!reading) return error_response(reading.error());
  const CleanPicture& rectified = reading->rectified;
  const auto sha = p.files.put(rectified.bytes);
  if (!sha) return error_response(sha.error());
  const auto kept = p.store.add_picture({plan, "rectified", *sha, rectified.media_type, rectified.width_px,
                                         rectified.height_px, p.clock->now() / 1'000'000});
  if (!kept) return error_response(kept.error());
  Json answer = layout_to_json(reading->layout, reading->sheet);
  answer["rectified"] = "/api/plans/" + plan + "/rectified?v=" + *sha;
  return json_response(answer);
}

Response read_sketch(const ApiParts& p, const Request& request) {
  const auto reading = p.pictures.read_sketch_photo(request.body);
  if (!reading) return error_response(reading.error());
  Json strokes = Json::array();
  for (const Stroke& stroke : reading->strokes)
    strokes.push_back({{"points", points_json(stroke.points_px, 0.01)}, {"kind", word_of(kStrokeWords, stroke.kind)}});
  return json_response({{"width", reading->width_px}, {"height", reading->height_px}, {"strokes", std::move(strokes)}});
}

using Answer = Response (*)(const ApiParts&, const Request&);

Handler with(const ApiParts& parts, Answer answer) {
  return [parts, answer](const Request& request, const Respond& respond) { respond(answer(parts, request)); };
}

}  // namespace

void add_picture_api(HttpService& service, const ApiParts& parts) {
  service.add({Method::kPost, "/api/plans", Role::kCommander, kMostPictureBytes, true, with(parts, upload_plan)});
  service.add({Method::kPost, "/api/plans/{id}/read", Role::kCommander, kMostReadBody, true, with(parts, read_plan)});
  service.add(
      {Method::kPost, "/api/sketch-photo", Role::kFirefighter, kMostPictureBytes, true, with(parts, read_sketch)});
  service.add({Method::kGet, "/api/plans/{id}/picture", Role::kObserver, 0, true,
               with(parts, [](const ApiParts& p, const Request& r) { return stored_picture(p, r, "picture"); })});
  service.add({Method::kGet, "/api/plans/{id}/rectified", Role::kObserver, 0, true,
               with(parts, [](const ApiParts& p, const Request& r) { return stored_picture(p, r, "rectified"); })});
}

}  // namespace smokemap::server
