#pragma once

#include "server/http/api.hpp"

namespace smokemap::server {

/// Uploads of plans and sketch photos, reading them, and the pictures as stored.
void add_picture_api(HttpService& service, const ApiParts& parts);

}  // namespace smokemap::server
