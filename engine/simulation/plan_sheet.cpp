#include <array>

#include "simulation/plan_canvas.hpp"

namespace smokemap {
namespace {

const cv::Scalar kSafetyGreen(80, 132, 0), kFireRed(30, 24, 190), kMandatoryBlue(170, 90, 0), kInk(30, 30, 30),
    kPaper(255, 255, 255), kHairline(150, 150, 150);

struct Note {
  const char* heading;
  cv::Scalar colour;
  std::array<const char*, 4> lines;
};

void draw_note(PlanCanvas& canvas, const Note& note, double left, double top, double right, double unit) {
  canvas.box({left, top}, {right, top + 30 * unit}, note.colour);
  canvas.text(note.heading, {left + 12 * unit, top + 21 * unit}, 12 * unit, kPaper, PlanCanvas::Anchor::kLeft, true);
  for (std::size_t i = 0; i < note.lines.size(); ++i)
    canvas.text(note.lines[i], {left + 12 * unit, top + (56 + 23 * static_cast<double>(i)) * unit}, 9.5 * unit, kInk);
}

}  // namespace

const char* colour_word(PlanSymbol symbol) {
  switch (symbol) {
    case PlanSymbol::kExit:
    case PlanSymbol::kFirstAid:
      return "green";
    case PlanSymbol::kExtinguisher:
    case PlanSymbol::kAlarm:
      return "red";
    case PlanSymbol::kYouAreHere:
      return "blue";
  }
  return "";
}

void draw_symbol(PlanCanvas& canvas, PlanSymbol symbol, const Point2& c, double size_px) {
  const double h = size_px / 2;
  const auto at = [&](double x, double y) { return Point2(c.x() + x * h, c.y() + y * h); };
  const auto square = [&](const cv::Scalar& colour) { canvas.box(at(-1, -1), at(1, 1), colour); };
  switch (symbol) {
    case PlanSymbol::kExit:  // a door and an arrow through it
      square(kSafetyGreen);
      canvas.box(at(0.15, -0.7), at(0.75, 0.7), kPaper);
      canvas.arrow(at(-0.8, 0), at(0.55, 0), 0.28 * h, kPaper);
      canvas.arrow(at(0.1, 0), at(0.6, 0), 0.28 * h, kSafetyGreen);
      return;
    case PlanSymbol::kFirstAid:
      square(kSafetyGreen);
      canvas.box(at(-0.2, -0.7), at(0.2, 0.7), kPaper);
      canvas.box(at(-0.7, -0.2), at(0.7, 0.2), kPaper);
      return;
    case PlanSymbol::kExtinguisher:  // a bottle with a hose
      square(kFireRed);
      canvas.box(at(-0.3, -0.3), at(0.2, 0.75), kPaper);
      canvas.box(at(-0.15, -0.6), at(0.05, -0.3), kPaper);
      canvas.line(at(0.05, -0.5), at(0.6, -0.1), 0.14 * h, kPaper);
      return;
    case PlanSymbol::kAlarm:
      square(kFireRed);
      canvas.disc(c, 0.6 * h, kPaper);
      canvas.disc(c, 0.28 * h, kFireRed);
      return;
    case PlanSymbol::kYouAreHere:
      canvas.disc(c, h, kMandatoryBlue);
      canvas.disc(c, 0.45 * h, kPaper);
      return;
  }
}

void draw_sheet(PlanCanvas& canvas, const std::string& title, const std::string& subtitle) {
  const double unit = canvas.width_px() / 1600.0, width = canvas.width_px(), height = canvas.height_px();
  canvas.box({24 * unit, 24 * unit}, {width - 24 * unit, 104 * unit}, kSafetyGreen);
  canvas.text(title, {52 * unit, 76 * unit}, 30 * unit, kPaper, PlanCanvas::Anchor::kLeft, true);
  canvas.text(subtitle, {width - 560 * unit, 73 * unit}, 16 * unit, kPaper);
  const Polygon frame{{14 * unit, 14 * unit},
                      {width - 14 * unit, 14 * unit},
                      {width - 14 * unit, height - 14 * unit},
                      {14 * unit, height - 14 * unit}};
  for (std::size_t i = 0; i < 4; ++i) canvas.line(frame[i], frame[(i + 1) % 4], 1.2 * unit, kHairline);

  const double left = width - 400 * unit, right = width - 40 * unit;
  draw_note(canvas,
            {"In case of fire",
             kFireRed,
             {"Keep calm. Report the fire: call 112.", "Warn others, help those who need it.",
              "Follow the green signs. Do not use lifts.", "Go to the assembly point."}},
            left, 150 * unit, right, unit);
  draw_note(canvas,
            {"In case of accident",
             kSafetyGreen,
             {"Report: who, where, what happened,", "how many are hurt. Wait for questions.", "Give first aid.",
              "Guide the rescuers."}},
            left, 345 * unit, right, unit);

  canvas.box({left, 540 * unit}, {right, 570 * unit}, kInk);
  canvas.text("Legend", {left + 12 * unit, 561 * unit}, 12 * unit, kPaper, PlanCanvas::Anchor::kLeft, true);
  const std::array<std::pair<PlanSymbol, const char*>, 5> symbols{{{PlanSymbol::kYouAreHere, "You are here"},
                                                                   {PlanSymbol::kExit, "Emergency exit"},
                                                                   {PlanSymbol::kFirstAid, "First aid"},
                                                                   {PlanSymbol::kExtinguisher, "Fire extinguisher"},
                                                                   {PlanSymbol::kAlarm, "Fire alarm"}}};
  double y = 600 * unit;
  for (const auto& [symbol, words] : symbols) {
    draw_symbol(canvas, symbol, {left + 26 * unit, y}, 24 * unit);
    canvas.text(words, {left + 58 * unit, y + 5 * unit}, 10.5 * unit, kInk);
    y += 38 * unit;
  }
  canvas.box({left + 12 * unit, y - 10 * unit}, {left + 42 * unit, y + 10 * unit}, cv::Scalar(205, 235, 205));
  canvas.arrow({left + 14 * unit, y}, {left + 40 * unit, y}, 4 * unit, kSafetyGreen);
  canvas.text("Escape route", {left + 58 * unit, y + 5 * unit}, 10.5 * unit, kInk);

  canvas.line({24 * unit, height - 62 * unit}, {width - 24 * unit, height - 62 * unit}, 1 * unit, kHairline);
  canvas.text("Keep escape routes clear.   Plan 01 of 01   Rev. 3", {40 * unit, height - 35 * unit}, 9 * unit, kInk);
  canvas.text("drawn to ISO 23601", {width - 230 * unit, height - 35 * unit}, 9 * unit, kInk);
}

}  // namespace smokemap
