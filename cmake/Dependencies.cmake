# Everything third-party, from Debian 12. Imported targets only: their headers count as system headers.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4 REQUIRED COMPONENTS core imgproc imgcodecs calib3d ximgproc)
find_package(Ceres 2 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(GTest REQUIRED)
find_package(CycloneDDS REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(POPPLER REQUIRED IMPORTED_TARGET poppler-cpp)

# 1.74, Debian's default, lacks the message-size and per-message compression controls of Beast.
find_package(Boost QUIET)
if(NOT Boost_FOUND OR Boost_VERSION VERSION_LESS 1.81)
  message(FATAL_ERROR "Smokemap needs Boost 1.81 or later, found '${Boost_VERSION}'. "
                      "On Debian 12: apt-get install libboost1.81-dev (it replaces libboost-dev).")
endif()
