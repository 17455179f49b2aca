"""What pages of other origins may send and see, where their origins are allowed (CORS)."""

from __future__ import annotations

METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE")

HEADERS = (
    "Authorization",
    "Content-Type",
    "Idempotency-Key",
    "If-Match",
    "If-None-Match",
    "Last-Event-ID",
    "Prefer",
    "X-Request-ID",
)
"""That pages may send, besides those that they always may."""

EXPOSED_HEADERS = (
    "Content-Disposition",
    "ETag",
    "Link",
    "Location",
    "Preference-Applied",
    "RateLimit",
    "RateLimit-Policy",
    "Retry-After",
    "Server-Timing",
    "Tubeloom-Cache",
    "Tubeloom-Revision",
    "Tubeloom-Samples",
    "Tubeloom-Since",
    "Tubeloom-Stopped-By",
    "WWW-Authenticate",
    "X-Request-ID",
)
"""That pages may read, besides those that they always may."""
