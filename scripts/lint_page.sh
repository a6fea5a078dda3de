#!/bin/sh
# Lint the scripts of fdspec explore with Biome from the npm registry, each page's as the one script that it is:
# names that nothing declares, names that nothing uses, and Biome's recommended rules.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python - "$folder" <<'END'
import sys
from pathlib import Path
from fdspec.explore.page import BUILDINGS, FRAMES, own_script
for name, scripts in (("frames", FRAMES), ("buildings", BUILDINGS)):
    Path(sys.argv[1], f"{name}.js").write_text(own_script(scripts), encoding="utf-8")
END
# Both pages share scripts, of which frames alone uses all.
cat > "$folder/biome.json" <<'END'
{
  "linter": {
    "rules": {
      "correctness": { "noUndeclaredVariables": "error", "noUnusedVariables": "error" },
      "style": { "useTemplate": "off" },
      "suspicious": { "noRedundantUseStrict": "off" }
    }
  },
  "overrides": [
    { "includes": ["**/buildings.js"], "linter": { "rules": { "correctness": { "noUnusedVariables": "off" } } } }
  ],
  "javascript": { "globals": ["Plotly"] }
}
END
cd "$folder"
npx --yes @biomejs/biome@2.6.8 lint --error-on-warnings frames.js buildings.js
