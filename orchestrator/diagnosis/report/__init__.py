"""The report of a diagnosis: report.html, figures, courses as CSV, and what the terminal shows."""

from orchestrator.diagnosis.report.courses import ChannelCourse, Contact, LandingCourses, RestValue
from orchestrator.diagnosis.report.distinction import Distinction, EffectSeen, MoreSensor
from orchestrator.diagnosis.report.page import write_report
from orchestrator.diagnosis.report.page_distinction import write_distinction
from orchestrator.diagnosis.report.terminal import terminal_distinguish, terminal_summary
from orchestrator.diagnosis.report.words import verdict_sentence

__all__ = [
    "ChannelCourse",
    "Contact",
    "Distinction",
    "EffectSeen",
    "LandingCourses",
    "MoreSensor",
    "RestValue",
    "terminal_distinguish",
    "terminal_summary",
    "verdict_sentence",
    "write_distinction",
    "write_report",
]
