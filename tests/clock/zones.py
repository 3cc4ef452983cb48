"""Makes zones.txt: what clocks are ahead of UTC, by CPython's zoneinfo and the package tzdata.

    pip install tzdata==2026.6
    python3 tests/clock/zones.py > tests/clock/zones.txt
"""

import platform
import zoneinfo
from collections import defaultdict
from datetime import datetime, timezone

import tzdata

DAYS = "1970-07-01 1985-01-15 2007-03-20 2020-10-28 2026-07-01 2026-12-21 2050-01-15 2100-07-01 2150-12-21".split()

# the package's rules alone, not the system's
zoneinfo.reset_tzpath(to=[])
instants = [datetime.fromisoformat(day).replace(hour=12, tzinfo=timezone.utc) for day in DAYS]


def offset(name, instant):
    secs = int(instant.astimezone(zoneinfo.ZoneInfo(name)).utcoffset().total_seconds())
    sign, secs = "-" if secs < 0 else "+", abs(secs)
    text = f"{sign}{secs // 3600:02}:{secs // 60 % 60:02}"
    return text + f":{secs % 60:02}" if secs % 60 else text


rows = defaultdict(list)
for name in sorted(zoneinfo.available_timezones() - {"Factory"}):
    rows[" ".join(offset(name, instant) for instant in instants)].append(name)

print(f"# CPython {platform.python_version()}, zoneinfo; tzdata {tzdata.__version__}; tz {tzdata.IANA_VERSION}")
print(f"# ahead of UTC at 12:00 UTC of {' '.join(DAYS)}: zones")
for offsets, names in rows.items():
    print(f"{offsets}: {' '.join(names)}")
